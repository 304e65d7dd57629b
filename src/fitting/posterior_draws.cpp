#include "fitting/posterior_draws.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <cmath>

#include "base/interruption.hpp"
#include "base/random_streams.hpp"
#include "fitting/clip_windows.hpp"
#include "fitting/window_problem.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/base/random.hpp"

namespace mcdbn {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Deviation of a weak prior of all unknowns, as some have no residual: radians, metres.
constexpr double kUnknownDeviation = 10;

/// The normal distribution of one window: x = L⁻ᵀ z − C λ, where λ are the lengths of the body.
class WindowPosterior {
 public:
  WindowPosterior(const Sparse& derivatives, Eigen::Index lengths) {
    const Eigen::Index moving = derivatives.cols() - lengths;
    Sparse identity(derivatives.cols(), derivatives.cols());
    identity.setIdentity();
    const Sparse all = Sparse(derivatives.transpose() * derivatives) +
                       identity / (kUnknownDeviation * kUnknownDeviation);
    const Sparse own = all.topLeftCorner(moving, moving);
    factor_.compute(own);
    if (factor_.info() != Eigen::Success)
      throw InputError(
          "the uncertainty of the fit to the track cannot be computed; does the track show a "
          "person?");
    if (lengths == 0) return;
    const Eigen::MatrixXd with_lengths = Sparse(all.topRightCorner(moving, lengths));
    of_lengths_ = factor_.solve(with_lengths);
    const Eigen::MatrixXd information =
        Eigen::MatrixXd(Sparse(all.bottomRightCorner(lengths, lengths))) -
        with_lengths.transpose() * of_lengths_;
    lengths_.compute(information);
  }

  /// @param normal [lengths], standard  @return the lengths' differences from the likeliest
  Eigen::VectorXd draw_lengths(const Eigen::VectorXd& normal) const {
    return normal.size() == 0 ? normal : lengths_.matrixU().solve(normal);
  }

  /// The window's own part. @param normal [frames·(3·orientations + 3)], standard
  Eigen::VectorXd draw(const Eigen::VectorXd& normal) const {
    return factor_.permutationPinv() * factor_.matrixU().solve(normal);
  }
  /// The part that follows from the body's lengths.
  Eigen::VectorXd with_lengths(const Eigen::VectorXd& lengths) const {
    if (of_lengths_.size() == 0) return Eigen::VectorXd::Zero(factor_.cols());
    return -(of_lengths_ * lengths);
  }

 private:
  Eigen::SimplicialLLT<Sparse> factor_;
  Eigen::MatrixXd of_lengths_;
  Eigen::LLT<Eigen::MatrixXd> lengths_;
};

/// Standard normal numbers of one draw. @param row of the key: which window, or the body's
Eigen::VectorXd normals(std::uint64_t seed, std::size_t draw, std::uint32_t row,
                        Eigen::Index count) {
  const RandomKey key{seed, static_cast<std::uint32_t>(draw), random_streams::kPosteriorDraws, 0};
  return Eigen::VectorXd::NullaryExpr(count, [&](Eigen::Index i) {
    return random_normal(key, row, static_cast<std::uint32_t>(i));
  });
}

/// A window's part of a draw, [frames·(3·orientations + 3)] each.
struct WindowDraw {
  Eigen::VectorXd own, of_body;
};

/// Adds a window's draw to the point. Where windows overlap their own parts count by the root of
/// their share, so that a sum of two independent draws deviates as much as each. What follows from
/// the body, which is the same for both, counts by the share itself.
/// @param before the window before, and its part that follows from the body
void add(PosteriorPoint& point, const ClipWindow& window, const ClipWindow& before,
         const PosteriorPoint& likeliest, const WindowDraw& drawn,
         const Eigen::VectorXd& body_before) {
  const Eigen::Index turns = point.turns.cols(), of_frame = turns + 3;
  for (Eigen::Index t = 0; t < window.frames; ++t) {
    const double share = share_of_window(window, before.end(), t);
    const Eigen::Index frame = window.first + t, first = t * of_frame,
                       then = (frame - before.first) * of_frame;
    const auto mix = [&](auto stands, const auto& centre, Eigen::Index at) {
      using Row = Eigen::RowVectorXd;
      const Eigen::Index count = stands.size();
      const Row of_body = drawn.of_body.segment(first + at, count).transpose();
      const Row body = frame < before.end() ? Row(body_before.segment(then + at, count).transpose())
                                            : Row::Zero(count);
      const Row own = stands - centre - body;
      stands = centre + std::sqrt(1 - share) * own + (1 - share) * body + share * of_body +
               std::sqrt(share) * drawn.own.segment(first + at, count).transpose();
    };
    mix(point.turns.row(frame), likeliest.turns.row(frame), 0);
    mix(point.shift.row(frame), likeliest.shift.row(frame), turns);
  }
}

}  // namespace

std::vector<PosteriorPoint> posterior_draws(const PosteriorClip& clip, const RayNoise& noise,
                                            const TrackFitSettings& settings,
                                            const PosteriorPoint& likeliest, std::size_t count,
                                            std::uint64_t seed) {
  constexpr std::uint32_t kBody = 0;  // windows follow
  std::vector<PosteriorPoint> draws(count, likeliest);
  const std::vector<ClipWindow> windows = windows_of(clip.frames());
  const Eigen::Index lengths = clip.body_unknown ? likeliest.log_lengths.size() : 0;
  const auto posterior_of = [&](const ClipWindow& window) {
    check_interruption();
    WindowProblem problem(clip, noise, settings, likeliest, window.first, window.frames,
                          Unknowns::all);
    const Sparse derivatives = problem.derivatives();
    return WindowPosterior(derivatives,
                           derivatives.cols() - window.frames * (likeliest.turns.cols() + 3));
  };
  std::vector<Eigen::VectorXd> bodies(count, Eigen::VectorXd::Zero(likeliest.log_lengths.size()));
  if (lengths > 0) {
    const WindowPosterior determining = posterior_of(windows[most_seen(clip, windows)]);
    for (std::size_t i = 0; i < count; ++i) {
      bodies[i] =
          settings.draw_width_factor * determining.draw_lengths(normals(seed, i, kBody, lengths));
      draws[i].log_lengths += bodies[i];
    }
  }
  std::vector<Eigen::VectorXd> before(count);  // by draw, of the window before
  ClipWindow last{0, 0};
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const WindowPosterior window = posterior_of(windows[w]);
    const Eigen::Index moving = windows[w].frames * (likeliest.turns.cols() + 3);
    for (std::size_t i = 0; i < count; ++i) {
      check_interruption();
      const auto row = static_cast<std::uint32_t>(w + 1);
      // `bodies` are wider already.
      const Eigen::VectorXd normal = settings.draw_width_factor * normals(seed, i, row, moving);
      const WindowDraw drawn{window.draw(normal), window.with_lengths(bodies[i])};
      add(draws[i], windows[w], last, likeliest, drawn, before[i]);
      before[i] = drawn.of_body;
    }
    last = windows[w];
  }
  return draws;
}

}  // namespace mcdbn
