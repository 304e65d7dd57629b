#pragma once

#include <cstddef>
#include <cstdint>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/learning/cd_settings.hpp"
#include "mcdbn/learning/fine_tuning_settings.hpp"
#include "mcdbn/learning/mrbm_settings.hpp"
#include "mcdbn/learning/regeneration_settings.hpp"
#include "mcdbn/machines/size_limits.hpp"

namespace mcdbn {

/// The network's size and how it is learnt, whatever the data are: the paper's Table 2 and section
/// V, and what it leaves out.
struct LearningSettings {
  std::uint64_t seed = 1;
  /// One CRBM that sees 10 frames of history in each CDBN, where the paper has two of order 5: the
  /// same frames in all, at a third of the cost, so that the layer can be wider and trained longer.
  std::size_t order = 10;
  std::size_t hidden = 768;
  std::size_t layers = 1;
  std::size_t mrbm_hidden = 512;
  std::size_t look_ahead = 5;
  std::size_t batch = 100;
  /// The rates and epochs that suit an hour of motion would stop long before a minute's was learnt.
  std::size_t least_batches = 40;
  double people_power = 1;

  CdSettings gaussian;
  CdSettings binary{.gibbs_steps = 1, .rate = 1e-2, .rate_A = 1e-3, .rate_B = 1e-3};
  MrbmSettings mrbm;
  FineTuningSettings fine_tuning;
  RegenerationSettings regeneration;

  /// The paper's architecture for the greedy stages alone, at rates and for epochs that train it:
  /// two CRBMs of order 5 and 300 units in each CDBN.
  static LearningSettings greedy();
  /// The paper's own figures (Table 2, section V.C): rate 0.1 and momentum 0.9 throughout, weights
  /// from N(0, 1), MRBM of 150, no look-ahead, k = 5 sampled steps in training and 3 in
  /// regeneration. Diverges, which the guard reports.
  static LearningSettings paper();
  /// The nearest to it that trains: rates and first weights that do not diverge, all else the same.
  static LearningSettings paper_stable();
  /// For free-running generation: the greedy stages with one layer a CDBN, by CD-1 with noise on
  /// the histories, falling rates and all people alike (docs/generation.md).
  static LearningSettings generation();
  /// @throws ConfigError naming the setting that is out of range
  void validate() const { check_settings(*this); }

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"seed", any_seed(), "", "seed of all random numbers"}, self.seed);
    visit(Setting{"order", size_limits::kHistory, "frames",
                  "frames of history that every CRBM sees (N)"},
          self.order);
    visit(Setting{"hidden", size_limits::kUnits, "units", "hidden units of every CRBM"},
          self.hidden);
    visit(Setting{"layers", size_limits::kLayers, "CRBMs",
                  "CRBMs in each CDBN; each learns the code of the one below"},
          self.layers);
    visit(Setting{"mrbm-hidden", size_limits::kUnits, "units", "hidden units of the MRBM"},
          self.mrbm_hidden);
    visit(Setting{"look-ahead", size_limits::kLookAhead, "frames",
                  "the 3D code of frame t is inferred from the 2D code of frame t + look-ahead; 0: "
                  "causal, as in the paper"},
          self.look_ahead);
    visit(
        Setting{"batch", within(1, 1e5), "windows", "windows in a mini-batch of the greedy stages"},
        self.batch);
    visit(Setting{"least-batches", within(1, 1e6), "mini-batches",
                  "least mini-batches in an epoch; a small data set is visited several times"},
          self.least_batches);
    visit(Setting{"people-power", within(0, 1), "",
                  "greedy stages: a person is drawn with probability proportional to frames^power; "
                  "1: all frames alike, 0: all people alike"},
          self.people_power);
    visit_group("gaussian", self.gaussian, visit);
    visit_group("binary", self.binary, visit);
    visit_group("mrbm", self.mrbm, visit);
    visit_group("fine-tuning", self.fine_tuning, visit);
    visit_group("regeneration", self.regeneration, visit);
  }
};

}  // namespace mcdbn
