#pragma once

#include "corpus/held_out_person.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion_model/pose_fine_tuning.hpp"

namespace mcdbn::test {

/// Fine-tuning on a set of views. Of at least config.hold_out_among people one is held out
/// (person_to_hold_out).
inline TrainedNetwork fine_tune_on_views(Device& device, const Mcdbn& start,
                                         const TrainingSet& views, const TrainingConfig& config,
                                         const EpochObserver& observer = {}) {
  const auto person = person_to_hold_out(views, config.hold_out_among);
  if (!person)
    return fine_tune_on_poses(device, nullptr, start, ClipSource(views), nullptr, views.modalities,
                              config, observer);
  const TrainingSet others = views_without(views, *person), of_person = views_of(views, *person);
  const HeldOutPerson held_out{of_person, clip_names(of_person)};
  return fine_tune_on_poses(device, nullptr, start, ClipSource(others), &held_out, views.modalities,
                            config, observer);
}

}  // namespace mcdbn::test
