#include "mcdbn/corpus/clip_store.hpp"

namespace mcdbn {
namespace {

class ChannelsInMemory : public ClipChannels {
 public:
  explicit ChannelsInMemory(std::vector<MatrixD> clips) : clips_(std::move(clips)) {}
  MatrixD rows(std::size_t clip, int first, int frames) const override {
    return clips_[clip].middleRows(first, frames);
  }

 private:
  std::vector<MatrixD> clips_;
};

}  // namespace

ClipStore::ClipStore(std::vector<LoadedClip> clips) {
  std::vector<MatrixD> channels;
  for (LoadedClip& loaded : clips) {
    records_.push_back({std::move(loaded.clip), loaded.motion.skeleton, loaded.motion.frame_time_s,
                        loaded.motion.frames()});
    channels.push_back(std::move(loaded.motion.channels));
  }
  channels_ = std::make_shared<ChannelsInMemory>(std::move(channels));
}

Motion ClipStore::piece(std::size_t clip, int first, int frames) const {
  const ClipRecord& record = records_[clip];
  return {record.skeleton, record.frame_time_s, channels_->rows(clip, first, frames)};
}

double ClipStore::frames_at(double fps) const {
  double frames = 0;
  for (const ClipRecord& record : records_) frames += record.seconds() * fps;
  return frames;
}

}  // namespace mcdbn
