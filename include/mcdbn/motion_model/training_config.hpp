#pragma once

#include <cstddef>
#include <string>

#include "mcdbn/corpus/training_set.hpp"
#include "mcdbn/learning/learning_settings.hpp"
#include "mcdbn/motion/planted_foot.hpp"

namespace mcdbn {

/// Weights of the parts of fine-tuning's loss on the 3D modality, each a mean.
struct PoseLossWeights {
  /// Weight of the squared errors of standardized features; the others are relative to it.
  double features = 1.0;
  double positions = 0.0, velocities = 0.0, contacts = 0.0;
  /// Largest speed of a foot that counts as a contact, m/s on a 1.7 m body; see PlantedFoot.
  double planted_below_m_s = kPlantedInCapture.below_m_s;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"positions", within(0, 1e6), "",
                  "weight, in the loss, of the joints' squared distances from the truth, in units "
                  "of 5 cm"},
          self.positions);
    visit(Setting{"velocities", within(0, 1e6), "",
                  "weight of the squared errors of the joints' steps from frame to frame, in units "
                  "of 1 cm"},
          self.velocities);
    visit(Setting{"contacts", within(0, 1e6), "",
                  "weight of the same for feet that are planted in truth, in the world, the root's "
                  "travel included: against sliding"},
          self.contacts);
  }
};

/// Everything that shapes a training run on clips: how they become sequences, and how those are
/// learnt. Its settings are those of its parts and one more.
struct TrainingConfig : CorpusSettings, LearningSettings {
  /// Weights of fine-tuning's loss on the 3D modality.
  PoseLossWeights pose_loss{.positions = 0.5, .velocities = 0.2, .contacts = 0.1};
  /// Fewest people for one to be held out. With fewer people none is held out: without one of nine
  /// CMU walkers the error on unseen people is 28.7 instead of 23.6 mm, and the error on the one
  /// held out fell to the end.
  std::size_t hold_out_among = 20;
  bool half_precision = false;

  /// With LearningSettings::greedy, paper or paper_stable.
  static TrainingConfig greedy();
  static TrainingConfig paper();
  static TrainingConfig paper_stable();
  /// With LearningSettings::generation, on every frame of the clips' own rates up to 120 a second.
  static TrainingConfig generation();
  /// Many people, actions and skeletons, seen by a detector from anywhere, with poses that no clip
  /// holds: what the model that comes with the program is trained with (docs/corpus.md).
  static TrainingConfig general();
  /// Share of detector views for `--tracks detector`.
  static constexpr double kShareOfDetectorViews = 0.8;
  /// @throws ConfigError naming the setting that is out of range
  void validate() const { check_settings(*this); }

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    CorpusSettings::visit(self, visit);
    LearningSettings::visit(self, visit);
    visit_group("fine-tuning", self.pose_loss, visit);
    visit(Setting{"fine-tuning.hold-out-among", within(0, 1e6), "people",
                  "with at least this many people one is held out, and fine-tuning stops when the "
                  "loss on that person rises; 0: never"},
          self.hold_out_among);
    visit(Setting{"half-precision", on_or_off(), "",
                  "store the model's numbers in 16 bits each: half the file size"},
          self.half_precision);
  }
};

/// A setting's name up to version 0.1, still accepted: fine-tuning was called the joint stage.
/// Empty if it had no other name.
std::string former_name(const std::string& setting);

}  // namespace mcdbn
