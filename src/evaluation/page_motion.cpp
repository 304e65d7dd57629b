#include "evaluation/page_motion.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "evaluation/motion_code.hpp"
#include "motion/joint_sides.hpp"

namespace mcdbn {
namespace {

using nlohmann::ordered_json;

/// How much of each clip is shown.
struct Detail {
  std::size_t samples;
  bool others;
  int frame_step;
};

/// From everything to the least that is worth showing.
constexpr std::array kDetails = {Detail{std::numeric_limits<std::size_t>::max(), true, 1},
                                 Detail{5, true, 1},
                                 Detail{2, true, 1},
                                 Detail{3, true, 2},
                                 Detail{1, true, 2},
                                 Detail{1, true, 3},
                                 Detail{1, false, 3},
                                 Detail{1, false, 6}};

/// Whole millimetres (or pixels) of every `step`-th frame.
std::string encoded(const MatrixD& values, int step) {
  const Eigen::Index rows = (values.rows() + step - 1) / step;
  MatrixD kept(rows, values.cols());
  for (Eigen::Index row = 0; row < rows; ++row) kept.row(row) = values.row(row * step);
  return encode_series(kept);
}

/// Side of each point: −1 left, 1 right, 0 neither; an end of a limb is on its joint's side.
std::vector<int> sides_of(const ReportClip& clip) {
  std::vector<int> sides;
  for (std::size_t i = 0; i < clip.point_names.size(); ++i) {
    const bool end = i >= static_cast<std::size_t>(clip.joints);
    const Side side =
        side_of(clip.point_names[end ? static_cast<std::size_t>(clip.parents[i]) : i]);
    sides.push_back(side == Side::left ? -1 : side == Side::right ? 1 : 0);
  }
  return sides;
}

bool has_simpler_methods(const ReportClip& clip) {
  return std::ranges::any_of(clip.others, [](const auto& of) { return of.first != kMeanField; });
}

class ClipWriter {
 public:
  ClipWriter(const ReportClip& clip, const Detail& detail) : detail_(detail) {
    json_ = {{"name", clip.name},
             {"action", clip.action},
             {"trained_on", clip.trained_on},
             {"fps", clip.fps / detail.frame_step},
             {"frames", (clip.frames() + detail.frame_step - 1) / detail.frame_step},
             {"joints", clip.joints},
             {"points", clip.point_names},
             {"parents", clip.parents},
             {"sides", sides_of(clip)},
             {"width", clip.width_px},
             {"height", clip.height_px},
             {"truth", code(clip.truth_mm)},
             {"track", code(clip.track_px)},
             {"motions", ordered_json::array()}};
    const auto mean_field = clip.others.find(kMeanField);
    if (mean_field != clip.others.end()) add("mean field", "model", mean_field->second);
    for (std::size_t i = 0; i < std::min(detail.samples, clip.samples.size()); ++i)
      add(clip.samples.size() == 1 ? "model" : "sample " + std::to_string(i + 1), "model",
          clip.samples[i]);
    if (!detail.others) return;
    for (const auto& [name, motion] : clip.others)
      if (name != kMeanField) add(name, "baseline", motion);
  }

  ordered_json take() { return std::move(json_); }
  std::size_t bytes() const { return bytes_; }

 private:
  std::string code(const MatrixD& values) {
    std::string text = encoded(values, detail_.frame_step);
    bytes_ += text.size();
    return text;
  }
  void add(const std::string& label, const char* kind, const ReportMotion& motion) {
    json_["motions"].push_back({{"label", label},
                                {"kind", kind},
                                {"mpjpe_mm", motion.score.error.mpjpe_mm},
                                {"points_mm", code(motion.points_mm)}});
    if (motion.deviation_mm.size() > 0)
      json_["motions"].back()["deviation_mm"] = code(motion.deviation_mm);
  }

  const Detail& detail_;
  ordered_json json_;
  std::size_t bytes_ = 0;
};

}  // namespace

PageMotion page_motion(const std::vector<ReportClip>& clips, std::size_t budget_bytes) {
  PageMotion most;
  most.left_out_clips = clips.size();
  for (const Detail& detail : kDetails) {
    PageMotion motion;
    motion.frame_step = detail.frame_step;
    motion.others = detail.others || std::ranges::none_of(clips, has_simpler_methods);
    motion.samples = clips.empty() ? 0 : std::min(detail.samples, clips.front().samples.size());
    std::size_t bytes = 0;
    for (const ReportClip& clip : clips) {
      ClipWriter writer(clip, detail);
      if (bytes + writer.bytes() > budget_bytes) continue;  // a shorter one may fit
      bytes += writer.bytes();
      motion.clips.push_back(writer.take());
    }
    motion.left_out_clips = clips.size() - motion.clips.size();
    const bool all = motion.left_out_clips == 0;
    // Less detail is worth it where it makes room for more clips.
    if (all || motion.clips.size() > most.clips.size()) most = std::move(motion);
    if (all) break;
  }
  return most;
}

}  // namespace mcdbn
