#include "mcdbn/motion_model/training_sources.hpp"

#include "corpus/augmented_views.hpp"

namespace mcdbn {

const TrainingSet& ViewSource::views() const {
  if (!views_) {
    make_views(0);
    if (config_.fine_tuning.new_views_every == 0) clips_ = {};
  }
  return *views_;
}

bool ViewSource::renew(std::size_t round) const {
  if (clips_.empty()) return false;
  make_views(round);
  return true;
}

void ViewSource::make_views(std::size_t round) const {
  // Seeds are small numbers: no round draws what another run's does.
  views_ = make_augmented_views(clips_, modalities_, config_, config_.seed + (round << 32U));
  // Where one round hides nothing another may: all of them say what was seen.
  if (config_.fine_tuning.new_views_every > 0 && views_->tracks_seen.empty())
    for (const MatrixF& track : views_->tracks)
      views_->tracks_seen.emplace_back(MatrixF::Ones(track.rows(), track.cols()));
}

}  // namespace mcdbn
