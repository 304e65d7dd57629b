#pragma once

#include <array>

#include "comparison/bimodal_data.hpp"
#include "mcdbn/base/random.hpp"
#include "mcdbn/device/parameters.hpp"

namespace mcdbn {

/// A deep Boltzmann machine of two modalities (Srivastava and Salakhutdinov 2014): Gaussian visible
/// units v of variance 1 and binary units h for each, and binary units z above both. In arrays of
/// two the 2D modality comes first.
///
///     E = Σ_m [ ½‖v_m − a_m‖² − v_m·W_m·h_mᵀ − b_m·h_mᵀ − h_m·U_m·zᵀ ] − c·zᵀ
///
/// All methods work on rows of one mini-batch, enqueue and return.
class DbmMachine {
 public:
  /// One modality's parameters in place.
  struct Pathway {
    Matrix W, U, a, b;
    Pathway(const Parameters& parameters, std::size_t modality);
  };

  /// Units of every layer: of data, of chains, or their means. Units that are drawn beside their
  /// probabilities have a matrix for each.
  struct Units {
    Units(Device& device, const BimodalShape& shape, std::size_t rows);
    std::array<Matrix, 2> visible, hidden;
    Matrix joint;
    std::array<Matrix, 2> hidden_draws;
    std::array<Matrix, 2> input_from_below;  ///< of the hidden units: scale · v·W + b
  };

  /// W_track, a_track, …, c. Weights from N(0, 0.01²), biases zero.
  DbmMachine(Device& device, const BimodalShape& shape, RandomKey key);

  const BimodalShape& shape() const { return shape_; }
  const Parameters& parameters() const { return parameters_; }
  Device& device() const { return parameters_.device(); }
  /// After weights changed.
  void refresh_transposed();

  /// input_from_below = scale · v·W + b. Greedy stages double what comes from below, as there is
  /// nothing above yet.
  void set_input_from_below(std::size_t m, Units& units, float scale = 1.0F) const;
  /// p(h_m = 1 | v_m, z) with the input from below; to hidden. With a key, draws to hidden_draws
  /// too.
  void infer_hidden(std::size_t m, Units& units, const RandomKey* draws = nullptr) const;
  /// As infer_hidden(), without z: σ(input_from_below).
  void infer_hidden_from_below(std::size_t m, Units& units, const RandomKey* draws = nullptr) const;
  /// p(z = 1 | h) of these hidden units; to joint. With a key the draws take its place.
  void infer_joint(const std::array<Matrix, 2>& hidden, Units& units,
                   const RandomKey* draws = nullptr) const;
  /// The mean of v_m given these hidden units; to visible. With a key a draw takes its place.
  void infer_visible(std::size_t m, const Matrix& hidden, Units& units,
                     const RandomKey* draws = nullptr) const;
  /// p(h_m | z) with the input doubled: in the top's greedy stage there is no layer below.
  void infer_hidden_from_above(std::size_t m, Units& units) const;

  /// Mean field with v_m clamped for both (`absent` 2) or one of the modalities; the other's starts
  /// at its visible bias. @param steps of hidden, joint and absent visible units
  void mean_field(Units& units, std::size_t absent, std::size_t steps) const;
  static constexpr std::size_t kNoneAbsent = 2;

  /// One sweep of the chains: h given v and z, then v and z given h. Uses five phases from
  /// draws.phase on.
  void gibbs_sweep(Units& chains, RandomKey draws) const;

  /// gradient = scale · (∂E/∂θ over the rows) + beta · gradient, h and z being means.
  void add_energy_gradient(const Units& units, float scale, float beta,
                           const Parameters& gradients) const;

 private:
  BimodalShape shape_;
  Parameters parameters_;
  std::array<Pathway, 2> pathways_;
  Matrix c_;
  std::array<Matrix, 2> W_transposed_, U_transposed_;
};

}  // namespace mcdbn
