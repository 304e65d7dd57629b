#include "mcdbn/motion_model/training_sources.hpp"

#include "corpus/augmented_views.hpp"

namespace mcdbn {

const TrainingSet& ViewSource::views() const {
  if (!views_) {
    views_ = make_augmented_views(clips_, modalities_, config_, config_.seed);
    clips_ = {};
  }
  return *views_;
}

}  // namespace mcdbn
