#include "comparison/multimodal_dbm.hpp"

#include "base/random_phases.hpp"
#include "base/random_streams.hpp"
#include "comparison/bimodal_data.hpp"
#include "comparison/clip_pairs.hpp"
#include "comparison/dbm_training.hpp"
#include "comparison/track_window.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

MultimodalDbm::MultimodalDbm(Device& device, const MultimodalDbmSettings& settings)
    : device_(&device), settings_(settings) {
  settings_.validate();
}

MultimodalDbm::~MultimodalDbm() = default;

void MultimodalDbm::fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) {
  const std::array<MatrixF, 2> data = bimodal_data(tracks, poses);
  const BimodalShape shape =
      bimodal_shape(data, {settings_.track_hidden, settings_.pose_hidden}, settings_.joint);
  machine_ =
      std::make_unique<DbmMachine>(*device_, shape,
                                   RandomKey{settings_.seed, 0, random_streams::kBoltzmannMachine,
                                             random_phases::kFirstWeights});
  DbmTraining(*machine_, settings_, data).run();
  if (!machine_->parameters().all().to_host().allFinite())
    throw Error("multimodal_dbm: training diverged; a lower rate may help");
  track_dimension_ = tracks.front().cols();
}

MatrixF MultimodalDbm::predict(const MatrixF& track) const {
  check_track(track, track_dimension_);
  if (track.rows() == 0) return MatrixF(0, static_cast<Eigen::Index>(machine_->shape().visible[1]));
  DbmMachine::Units units(*device_, machine_->shape(), static_cast<std::size_t>(track.rows()));
  units.visible[0].upload(track_windows(track));
  machine_->mean_field(units, 1, settings_.inference_steps);
  return units.visible[1].to_host();
}

}  // namespace mcdbn
