#pragma once

#include <cstdint>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/machines/cdbn.hpp"
#include "mcdbn/machines/mrbm.hpp"
#include "mcdbn/machines/sequences.hpp"

namespace mcdbn {

/// How chains of Gibbs steps run (eq 6 to 11).
struct ChainSettings {
  std::size_t steps = 100;
  std::uint64_t seed = 1;
  bool means = false;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"steps", within(1, 1e6), "steps",
                  "Gibbs steps of a chain: with more a sample depends less on the chain's start"},
          self.steps);
    visit(Setting{"seed", any_seed(), "", "seed of all random numbers"}, self.seed);
    visit(Setting{"means", on_or_off(), "",
                  "the last step gives the visible units' means, which show more than draws"},
          self.means);
  }
};

/// Mean field: hidden probabilities of the frames, the visible units' means given those, so many
/// times. Histories stay the data's.
/// @param visible [all frames x visible]  @param steps at least 1
/// @return of that shape, in the data's units; frames without a history are zero
///         (Sequences::valid_from)
/// @throws ShapeError for no steps, and where the columns are not the visible units
Sequences reconstruct(const Crbm& crbm, const Sequences& visible, std::size_t steps = 1);

/// Up through all layers, `steps` at the top, down again; each layer's histories are the codes that
/// the data have there. Shapes as above, of the lowest layer's visible units; a frame's history is
/// that of all layers.
/// @throws ShapeError, also for a stack without layers
Sequences reconstruct(const Cdbn& cdbn, const Sequences& visible, std::size_t steps = 1);

/// Draws the visible units that are NaN, frame after frame: each frame's Gibbs steps start from the
/// frame before, what is given stands after each step, and the history is what was given or drawn.
/// Before a clip stands the training mean.
/// @param given clips [all frames x visible], NaN where a unit is to be drawn
/// @return the same clips without NaN
/// @throws ShapeError for no steps, and where the columns are not the visible units
Sequences sample_given(const Crbm& crbm, const Sequences& given, const ChainSettings& settings);

/// As sample_given() of a CRBM, each step up and down through all layers. The lower layers are
/// directed, so these are no exact draws from the stack's own conditional distribution.
/// @param given [all frames x visible units of the lowest layer]
/// @throws ShapeError, also for a stack without layers
Sequences sample_given(const Cdbn& cdbn, const Sequences& given, const ChainSettings& settings);

/// Mean field of an MRBM: the shared units from all modalities, each modality's means given those,
/// so many times.
/// @param modalities [rows x visible] of each, of as many rows  @param steps at least 1
/// @return as many, of the same shapes
/// @throws ShapeError for no steps, other modalities than the MRBM's, or different rows
std::vector<Matrix> reconstruct(const Mrbm& mrbm, const std::vector<Rows>& modalities,
                                std::size_t steps = 1);

/// Chains of an MRBM from zeros: the modalities that are given stay, the others are drawn, all of
/// them where nothing is given.
/// @param modalities [rows x visible] of each; those that are not given may be empty matrices
/// @param given of each modality  @param rows of the result
/// @return of each modality [rows x visible]
/// @throws ShapeError for other modalities than the MRBM's, given ones of another shape, and where
///         all are given
std::vector<Matrix> sample(const Mrbm& mrbm, const std::vector<Matrix>& modalities,
                           const std::vector<bool>& given, std::size_t rows,
                           const ChainSettings& settings);

/// Free chains of an RBM. `start` may be Matrix::filled_with_row(rbm.visible_mean, chains).
/// @param start [chains x visible]  @return [chains x visible]
/// @throws ShapeError for no steps, other columns, and a machine with a history: it generates
///         sequences instead
Matrix sample(const Crbm& rbm, const Matrix& start, const ChainSettings& settings);

/// Free chains of a DBN: the top machine's chains start from the code of `start`, and the layers
/// beneath give one draw down (Hinton et al. 2006).
/// @param start [chains x visible units of the lowest layer]  @return of that shape
/// @throws ShapeError as sample() of an RBM, for a history in any layer, and for no layers
Matrix sample(const Cdbn& dbn, const Matrix& start, const ChainSettings& settings);

}  // namespace mcdbn
