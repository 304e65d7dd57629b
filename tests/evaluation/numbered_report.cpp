#include "numbered_report.hpp"

#include "clips.hpp"

namespace mcdbn::test {
namespace {

struct Line {
  double base, slope;
};

const std::map<std::string, Line>& lines() {
  static const std::map<std::string, Line> all = {{"pcc_flat", {0.97, -0.0011}},
                                                  {"pcc_channel", {0.85, -0.0023}},
                                                  {"mpjpe_mm", {20, 1}},
                                                  {"pa_mpjpe_mm", {11, 0.7}},
                                                  {"limb_mpjpe_mm", {31, 1.1}},
                                                  {"limb_turned_mpjpe_mm", {28, 0.9}},
                                                  {"limb_pa_mpjpe_mm", {19, 0.8}},
                                                  {"mpjae_deg", {9, 0.3}},
                                                  {"mpjve_mm_s", {100, 3}},
                                                  {"acceleration_error_mm_s2", {1000, 5}},
                                                  {"pck_150mm", {0.95, -0.001}},
                                                  {"root_mm", {40, 7}},
                                                  {"rmse_mm", {26, 1.3}},
                                                  {"foot_slide_mm_s", {17, 4}},
                                                  {"foot_slide_of_truth_mm_s", {13, 0.5}},
                                                  {"bone_length_spread_mm", {0.5, 0.1}},
                                                  {"within_90", {0.8, 0.0017}}};
  return all;
}

ReportClip numbered_clip(const std::string& name, const std::string& action, int number,
                         int frames) {
  const auto seed = static_cast<unsigned>(100 * number);
  ReportClip clip;
  clip.name = name;
  clip.action = action;
  clip.fps = 25;
  clip.point_names = {"Hips", "Chest", "Head", "Head end"};
  clip.parents = {-1, 0, 1, 2};
  clip.joints = 3;
  // About one pose, so that clips correlate; deviations differ from clip to clip.
  MatrixD pose(1, 12);
  pose << 0, 900, 30, 20, 1300, 10, -40, 1650, 0, -40, 1800, 10;
  clip.truth_mm = pose.replicate(frames, 1) + random_clip(frames, 12, 90 + 15 * number, seed);
  clip.track_px = random_clip(frames, 6, 100, seed + 1);
  clip.track_px(1, 2) = NAN;
  clip.width_px = 640;
  clip.height_px = 480;
  for (int sample = 0; sample < 2; ++sample)
    clip.samples.push_back({clip.truth_mm + random_clip(frames, 12, 60 + 10 * sample,
                                                        seed + 2 + static_cast<unsigned>(sample)),
                            numbered_score(10 * number + 3 - sample)});
  clip.others["ridge_window"] = {clip.truth_mm * 1.01, numbered_score(kRidgeNumber)};
  clip.others["mean_pose"] = {clip.truth_mm * 0.99, numbered_score(kMeanPoseNumber)};
  clip.track = {12.5 * number, 40.0 + number};
  clip.others[kMeanField] = {clip.truth_mm * 1.02, numbered_score(kMeanFieldNumber)};
  return clip;
}

}  // namespace

ClipScore numbered_score(double number) {
  const auto at = [&](const char* name) {
    const Line& line = lines().at(name);
    return line.base + line.slope * number;
  };
  ClipScore score;
  score.pcc_flat = at("pcc_flat");
  score.pcc_channel = at("pcc_channel");
  score.error.mpjpe_mm = at("mpjpe_mm");
  score.error.pa_mpjpe_mm = at("pa_mpjpe_mm");
  score.error.mpjve_mm_s = at("mpjve_mm_s");
  score.error.acceleration_error_mm_s2 = at("acceleration_error_mm_s2");
  score.error.pck_150mm = at("pck_150mm");
  score.error.rmse_mm = at("rmse_mm");
  score.limbs = {at("limb_mpjpe_mm"), at("limb_turned_mpjpe_mm"), at("limb_pa_mpjpe_mm")};
  score.mpjae_deg = at("mpjae_deg");
  score.root_mm = at("root_mm");
  score.foot_slide = {at("foot_slide_of_truth_mm_s"), at("foot_slide_mm_s"), 4};
  score.bone_length_spread_mm = at("bone_length_spread_mm");
  score.within_90 = at("within_90");
  return score;
}

std::map<std::string, double> numbered_figures(const std::vector<double>& numbers) {
  double mean = 0;
  for (const double number : numbers) mean += number / static_cast<double>(numbers.size());
  std::map<std::string, double> figures;
  for (const auto& [name, line] : lines()) figures[name] = line.base + line.slope * mean;
  return figures;
}

EvaluationReport numbered_report() {
  EvaluationReport report;
  report.model = "model.safetensors";
  report.protocol = "subject";
  report.temperature = 0.75;
  report.fit = "track";
  report.damage = {1.5, 0.25, 0.5};
  report.clips = {numbered_clip("a", "walk", 1, 24), numbered_clip("b", "jump", 2, 18),
                  numbered_clip("c", "walk", 3, 30), numbered_clip("d", "walk", 4, 20),
                  numbered_clip("e", "jump", 5, 26)};
  report.clips[2].trained_on = true;
  report.actions = analyse_actions(report.clips, 7);
  return report;
}

std::vector<double> sample_numbers(const EvaluationReport& report, const std::string& action) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < report.clips.size(); ++i)
    if (action.empty() || report.clips[i].action == action)
      for (const double sample : {3.0, 2.0})
        numbers.push_back(10 * static_cast<double>(i + 1) + sample);
  return numbers;
}

}  // namespace mcdbn::test
