#pragma once

#include <Eigen/Cholesky>

#include "comparison/baseline.hpp"
#include "mcdbn/base/settings.hpp"

namespace mcdbn {

/// Chosen by CMU's training walkers, one of them held out (docs/baselines.md).
struct TwinGaussianProcessSettings {
  std::size_t neighbours = 300;
  double track_width = 1.0, pose_width = 1.0;
  double track_noise = 1e-3, pose_noise = 1.0;
  std::size_t steps = 50;

  /// @throws ConfigError naming the setting that is out of range
  void validate() const { check_settings(*this); }

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"neighbours", within(1, 1e5), "frames",
                  "nearest training windows that a frame is predicted from: the time grows with "
                  "their cube"},
          self.neighbours);
    visit(Setting{"track-width", above(0, 1e6), "",
                  "width of the kernel on 2D windows; 1 is the root mean square distance of two "
                  "training windows"},
          self.track_width);
    visit(Setting{"pose-width", above(0, 1e6), "", "as track-width, of the kernel on poses"},
          self.pose_width);
    visit(Setting{"track-noise", above(0, 1e6), "",
                  "variance of the noise on windows, where the kernel's is 1"},
          self.track_noise);
    visit(Setting{"pose-noise", above(0, 1e6), "", "as track-noise, on poses"}, self.pose_noise);
    visit(Setting{"steps", within(0, 1e6), "steps",
                  "largest number of L-BFGS steps; 0: the answer is Gaussian process regression"},
          self.steps);
  }
};

/// One frame's problem: training windows and poses, and what the answer's kernel has to look like.
/// Both kernels are exp(−‖x − x'‖² / (2·width²)), with the noise's variance added for x = x'.
class TwinGaussianProcess {
 public:
  struct Kernel {
    double width = 1, noise = 1e-3;
    /// The kernel of one row with each of many. @return [rows]
    Eigen::VectorXd against(const MatrixD& rows, const Eigen::VectorXd& one) const;
    /// The kernel of all pairs of rows, with the noise. @return [rows x rows]
    MatrixD among(const MatrixD& rows) const;
  };

  /// @param windows [n x d], poses [n x d3], window [d] the one to answer
  TwinGaussianProcess(const MatrixD& windows, const MatrixD& poses, const Kernel& track,
                      const Kernel& pose, const Eigen::VectorXd& window);

  /// KL divergence of the two processes, but for a constant (Bo and Sminchisescu 2010, eq 12):
  /// k(r,r) − 2·uᵀk(r) − η·log(k(r,r) − k(r)ᵀK⁻¹k(r)), where u = K_x⁻¹k_x, η = k_x(x,x) − k_xᵀu.
  /// @param gradient [d3] by the pose
  double divergence(const Eigen::VectorXd& pose, Eigen::VectorXd& gradient) const;
  /// Gaussian process regression by the windows' kernel around the neighbours' mean.
  Eigen::VectorXd regression() const;

 private:
  const MatrixD& poses_;
  Kernel pose_kernel_;
  Eigen::LLT<Eigen::MatrixXd> pose_factor_;  ///< of K
  Eigen::VectorXd u_;
  double eta_ = 0;
};

/// Twin Gaussian processes of Bo and Sminchisescu (2010), the paper's [26], in their K-nearest
/// version: the answer is the pose whose similarity to the training poses is most like the 2D
/// window's similarity to theirs, by the KL divergence of two Gaussian processes. On the host, in
/// double.
class TwinGaussianProcesses : public Baseline {
 public:
  explicit TwinGaussianProcesses(const TwinGaussianProcessSettings& settings = {});

  std::string name() const override { return "twin_gaussian_process"; }
  void fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) override;
  MatrixF predict(const MatrixF& track) const override;

 private:
  /// Rows of the training windows that are nearest to one.
  std::vector<Eigen::Index> nearest(const RowVectorF& window) const;

  TwinGaussianProcessSettings settings_;
  Eigen::Index track_dimension_ = 0;
  MatrixF windows_, poses_;
  TwinGaussianProcess::Kernel track_kernel_, pose_kernel_;
};

}  // namespace mcdbn
