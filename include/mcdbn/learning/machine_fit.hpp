#pragma once

#include <span>
#include <vector>

#include "mcdbn/learning/cd_settings.hpp"
#include "mcdbn/learning/epoch_report.hpp"
#include "mcdbn/learning/learning_settings.hpp"
#include "mcdbn/learning/mrbm_settings.hpp"
#include "mcdbn/machines/cdbn.hpp"
#include "mcdbn/machines/mrbm.hpp"

namespace mcdbn {

/// How a machine of its own is fitted, whatever it is: settings that do not concern it are ignored.
struct MachineSettings {
  std::uint64_t seed = 1;
  std::size_t order = 3;
  std::size_t hidden = 100;
  std::size_t layers = 2;
  std::size_t batch = 100;
  std::size_t least_batches = 1;
  CdSettings gaussian = LearningSettings::greedy().gaussian;
  CdSettings binary = LearningSettings::greedy().binary;
  MrbmSettings mrbm = LearningSettings::greedy().mrbm;

  /// @throws ConfigError naming the setting that is out of range
  void validate() const { check_settings(*this); }

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"seed", any_seed(), "", "seed of all random numbers"}, self.seed);
    visit(Setting{"order", within(1, size_limits::kHistory.most), "frames",
                  "frames of history of every layer, of machines with history"},
          self.order);
    visit(Setting{"hidden", size_limits::kUnits, "units",
                  "hidden units of every layer, or of the MRBM"},
          self.hidden);
    visit(Setting{"layers", size_limits::kLayers, "machines",
                  "layers of a stack; each learns the code of the one below"},
          self.layers);
    visit(Setting{"batch", within(1, 1e5), "rows", "rows in a mini-batch"}, self.batch);
    visit(Setting{"least-batches", within(1, 1e6), "mini-batches",
                  "least mini-batches in an epoch; a small data set is visited several times"},
          self.least_batches);
    visit_group("gaussian", self.gaussian, visit);
    visit_group("binary", self.binary, visit);
    visit_group("mrbm", self.mrbm, visit);
  }
};

/// The size of one layer of a stack.
struct LayerSize {
  std::size_t hidden = 0;
  std::size_t order = 0;  ///< frames of history; 0 makes it an RBM
};

/// As many layers as the settings say, all alike. @param history false: RBMs, of order 0
std::vector<LayerSize> equal_layers(const MachineSettings& settings, bool history = true);

/// A stack, fitted layer by layer by contrastive divergence (train_cdbn); one layer is an RBM or a
/// CRBM, orders of 0 make it a DBN. Stages are called layer.0, layer.1 …
/// @param data numbers throughout, within 0 … 1 where the lowest layer's units are binary
/// @param kind of the lowest layer's visible units; those above see the code, which is binary
/// @param layers from below, e.g. equal_layers(settings)
/// @param observer is called after each epoch; may throw to stop
/// @throws InputError naming the first value that the units cannot take, its row counted over all
/// sequences; ConfigError for sizes or settings out of range; ShapeError if no row has a history,
/// or there is no layer; DivergenceError naming what to lower
Cdbn fit_stack(Device& device, const Sequences& data, VisibleKind kind,
               const std::vector<LayerSize>& layers, const MachineSettings& settings,
               const EpochObserver& observer = {});

/// An MRBM, fitted by the settings' rule on rows that belong together.
/// @param modalities name and kind of each
/// @param data of each, of the same clips; values as fit_stack takes them
/// @throws InputError, ConfigError, ShapeError, DivergenceError
Mrbm fit_mrbm(Device& device, const std::vector<Modality>& modalities,
              std::span<const Sequences> data, const MachineSettings& settings,
              const EpochObserver& observer = {});

}  // namespace mcdbn
