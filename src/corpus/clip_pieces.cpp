#include "corpus/clip_pieces.hpp"

#include <algorithm>
#include <cmath>

namespace mcdbn {

std::vector<ClipPiece> pieces_in_memory(const ClipStore& clips, double fps) {
  std::vector<ClipPiece> pieces;
  const double all = clips.frames_at(fps);
  if (all <= kMostFramesInMemory) {
    for (std::size_t i = 0; i < clips.count(); ++i)
      pieces.push_back({i, 0, clips.record(i).frames});
    return pieces;
  }
  const int count = static_cast<int>(kSomeFrames / kPieceFrames);
  double end = 0;
  int next = 0;
  for (std::size_t i = 0; i < clips.count(); ++i) {
    const ClipRecord& record = clips.record(i);
    const double begin = end, own = record.seconds() * fps;
    end += own;
    for (double at = 0; next < count && (at = (next + 0.5) * all / count) < end; ++next) {
      const int wanted = static_cast<int>(std::ceil(kPieceFrames / (fps * record.frame_time_s)));
      const int frames = std::min(wanted, record.frames);
      pieces.push_back(
          {i, static_cast<int>((at - begin) / own * (record.frames - frames)), frames});
    }
  }
  return pieces;
}

}  // namespace mcdbn
