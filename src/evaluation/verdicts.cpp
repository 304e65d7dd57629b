#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "evaluation/evaluation_report.hpp"
#include "evaluation/method_names.hpp"

namespace mcdbn {
namespace {

using Kind = Verdict::Kind;

const MethodReport* find(const std::vector<MethodReport>& methods, const std::string& name) {
  for (const MethodReport& method : methods)
    if (method.name == name) return &method;
  return nullptr;
}

/// The model's single best answer: its mean field where samples were drawn.
const ClipScore& answer_of(const ReportClip& clip) {
  const auto mean_field = clip.others.find(kMeanField);
  return mean_field == clip.others.end() ? clip.samples.front().score : mean_field->second.score;
}

const MethodReport& answer_of(const std::vector<MethodReport>& methods) {
  const MethodReport* mean_field = find(methods, kMeanField);
  return mean_field ? *mean_field : methods.front();
}

int clips_nearer_than(const std::vector<ReportClip>& clips, const std::string& baseline) {
  int nearer = 0;
  for (const ReportClip& clip : clips)
    nearer += answer_of(clip).error.mpjpe_mm < clip.others.at(baseline).score.error.mpjpe_mm;
  return nearer;
}

Verdict against(const EvaluationReport& report, const ClipScore& answer,
                const MethodReport& baseline) {
  const ClipScore& other = baseline.mean;
  const bool nearer = answer.error.mpjpe_mm < other.error.mpjpe_mm;
  // Where nothing moves there is nothing to follow.
  const bool correlates = std::isfinite(answer.pcc_channel) && std::isfinite(other.pcc_channel);
  const bool follows = correlates ? answer.pcc_channel > other.pcc_channel : nearer;
  const std::string figures =
      fmt::format("{:.1f} mm against {:.1f} mm, {}", answer.error.mpjpe_mm, other.error.mpjpe_mm,
                  correlates ? fmt::format("per-channel PCC {:.3f} against {:.3f}",
                                           answer.pcc_channel, other.pcc_channel)
                             : "no per-channel PCC, for nothing moves");
  const std::string count =
      fmt::format("nearer on {} of {} clips", clips_nearer_than(report.clips, baseline.name),
                  report.clips.size());
  const std::string_view name = method_name(baseline.name).spoken;
  if (nearer && follows)
    return {Kind::good, fmt::format("The model beats {}: {}; {}.", name, figures, count)};
  if (nearer)
    return {Kind::bad, fmt::format("The model is nearer to the truth than {}, but follows the "
                                   "motion less well: {}; {}.",
                                   name, figures, count)};
  if (follows)
    return {Kind::bad, fmt::format("The model is farther from the truth than {}, though it follows "
                                   "the motion better: {}; {}.",
                                   name, figures, count)};
  return {Kind::bad, fmt::format("The model loses to {}: {}; {}.", name, figures, count)};
}

void add_flat_warning(std::vector<Verdict>& list, const ClipScore& answer,
                      const std::vector<MethodReport>& methods, bool fitted) {
  const char* pose = fitted ? "the mean pose, fitted to the track," : "a pose that never moves";
  const MethodReport* mean_pose = find(methods, "mean_pose");
  if (!mean_pose) return;
  const double constant = mean_pose->mean.pcc_flat;
  if (constant >= answer.pcc_flat)
    list.push_back(
        {Kind::bad, fmt::format("By the flattened PCC that the paper reports, {} ({:.4f}) is as "
                                "good as the model ({:.4f}).",
                                pose, constant, answer.pcc_flat)});
  else if (constant > 0.8 && std::isfinite(mean_pose->mean.pcc_channel))
    list.push_back(
        {Kind::note, fmt::format("By the flattened PCC, {} reaches {:.4f} (the model: {:.4f}): "
                                 "judge by the per-channel PCC, where it gets {:.3g}.",
                                 pose, constant, answer.pcc_flat, mean_pose->mean.pcc_channel)});
}

/// Where several actions are reported: those on which a baseline is nearer.
void add_action_losses(std::vector<Verdict>& list, const ActionReport& action) {
  const MethodReport* mean_field = find(action.others, kMeanField);
  const ClipScore& answer = mean_field ? mean_field->mean : action.model.mean;
  for (const MethodReport& other : action.others)
    if (other.name != kMeanField && other.mean.error.mpjpe_mm <= answer.error.mpjpe_mm)
      list.push_back({Kind::bad, fmt::format("On {}, {} is nearer to the truth: {:.1f} mm against "
                                             "the model's {:.1f} mm.",
                                             action.name, method_name(other.name).spoken,
                                             other.mean.error.mpjpe_mm, answer.error.mpjpe_mm)});
}

void add_samples(std::vector<Verdict>& list, const ActionReport& action) {
  if (!action.diversity_mm) return;
  if (*action.diversity_mm < 0.01) {
    list.push_back({Kind::note, fmt::format("The {} regenerations of each {} clip are the same: "
                                            "above temperature 0 they differ.",
                                            action.samples, action.name)});
    return;
  }
  std::string text = fmt::format(
      "{}: {} samples of a clip differ by {:.1f} mm; a sample is off by {:.1f} mm on average, the "
      "best of {} by {:.1f} mm",
      action.name, action.samples, *action.diversity_mm, action.model.mean.error.mpjpe_mm,
      action.samples, action.best->mean.error.mpjpe_mm);
  Kind kind = Kind::note;
  if (const MethodReport* single = find(action.others, kMeanField)) {
    const bool better = action.best->mean.error.mpjpe_mm < single->mean.error.mpjpe_mm;
    kind = better ? Kind::good : Kind::bad;
    text += fmt::format(", the single mean-field answer by {:.1f} mm", single->mean.error.mpjpe_mm);
  }
  list.push_back({kind, text + "."});
}

void add_likeness(std::vector<Verdict>& list, const ActionReport& action) {
  if (!action.weibull_kl) {
    list.push_back(
        {Kind::note, fmt::format("{}: how alike real and regenerated clips are cannot be "
                                 "compared by Weibulls (it takes different, positive "
                                 "correlations of both).",
                                 action.name)});
    return;
  }
  const double real = action.pairs_real.statistics.median;
  const double regenerated = action.pairs_drawn.statistics.median;
  const char* alike = std::abs(regenerated - real) < 0.005 ? "about as alike as"
                      : regenerated > real                 ? "more alike than"
                                                           : "less alike than";
  list.push_back({*action.weibull_kl < 0.4 ? Kind::good : Kind::note,
                  fmt::format("{}: regenerated clips are {} real ones (median pairwise PCC {:.3f} "
                              "against {:.3f}; KL of the fitted Weibulls {:.3g} nats).",
                              action.name, alike, regenerated, real, *action.weibull_kl)});
}

void add_foot_slide(std::vector<Verdict>& list, const ClipScore& answer) {
  const FootSlide& slide = answer.foot_slide;
  if (!(slide.truth_mm_s > 0) || slide.planted == 0) return;
  const double ratio = slide.regenerated_mm_s / slide.truth_mm_s;
  list.push_back({ratio <= 1.5 ? Kind::good : Kind::bad,
                  fmt::format("Planted feet slide at {:.0f} mm/s, in the capture itself at {:.0f} "
                              "mm/s: {:.1f} times as fast.",
                              slide.regenerated_mm_s, slide.truth_mm_s, ratio)});
}

/// The share of the truth that 90 % intervals ought to hold: between these.
constexpr double kFewestWithin90 = 0.85, kMostWithin90 = 0.95;

/// Over all frames of all clips alike.
void add_uncertainty(std::vector<Verdict>& list, const Coverage& joints) {
  const double share = joints.overall().share();
  if (!std::isfinite(share)) return;
  const bool right = share >= kFewestWithin90 && share <= kMostWithin90;
  list.push_back({right ? Kind::good : Kind::bad,
                  fmt::format("Of 90 % intervals of the joints' places, {:.1f} % hold the truth{}.",
                              100 * share,
                              right                     ? ""
                              : share < kFewestWithin90 ? ": they are too narrow"
                                                        : ": they are too wide")});
}

void add_training_warning(std::vector<Verdict>& list, const EvaluationReport& report) {
  int trained = 0;
  for (const ReportClip& clip : report.clips) trained += clip.trained_on;
  if (trained == 0) return;
  list.push_back({Kind::bad, fmt::format("{} of {} clips were trained on: every figure that "
                                         "includes them flatters the model. They are marked.",
                                         trained, report.clips.size())});
}

/// The subject protocol is about people that the model has never seen.
void add_known_people(std::vector<Verdict>& list, const EvaluationReport& report) {
  std::set<std::string> people;
  int known = 0, unclear = 0;
  for (const ReportClip& clip : report.clips) {
    if (clip.trained_on) continue;
    if (!clip.known_person) {
      ++unclear;
    } else if (!clip.known_person->empty()) {
      people.insert(*clip.known_person);
      ++known;
    }
  }
  if (known > 0)
    list.push_back(
        {Kind::note, fmt::format("{} of {} clips show a person whom the model was trained "
                                 "on in other clips ({}): for people that it has never "
                                 "seen expect less.",
                                 known, report.clips.size(), fmt::join(people, ", "))});
  if (unclear > 0)
    list.push_back(
        {Kind::note, fmt::format("Whether the model was trained on the people in {} of {} clips is "
                                 "not known: its training clips are not here to compare, and the "
                                 "names of these do not tell.",
                                 unclear, report.clips.size())});
}

/// The simpler method that learns from the model's views where there are any; no other one does.
constexpr const char* kLearnsFromViews = "mlp_window";

bool some_learnt_from_clips(const EvaluationReport& report) {
  return std::ranges::any_of(report.clips, [](const ReportClip& clip) {
    return std::ranges::any_of(clip.others, [](const auto& other) {
      return other.first != kMeanField && other.first != kLearnsFromViews;
    });
  });
}

/// What was done to the tracks and to the answers, for all methods alike.
void add_treatment(std::vector<Verdict>& list, const EvaluationReport& report) {
  if (report.tracks != "exact")
    list.push_back(
        {Kind::note, fmt::format("The 2D tracks are as a detector's ({}), of other people than the "
                                 "clips' and through cameras drawn around them; every method saw "
                                 "the same, {}.",
                                 report.tracks,
                                 report.camera_known ? "and knew the camera" : "no camera known")});
  else if (!report.camera_known)
    list.push_back(
        {Kind::note, fmt::format("No method knew the camera: its place and lens were hidden.")});
  if (report.tracks != "exact" && some_learnt_from_clips(report))
    list.push_back(
        {Kind::note,
         fmt::format("Of the simpler methods {} alone can learn from the model's views: the others "
                     "learnt from the training clips' exact joints, as one camera sees them.",
                     method_name(kLearnsFromViews).spoken)});
  std::vector<std::string> damage;
  if (report.damage.noise_px > 0)
    damage.push_back(fmt::format("{:g} px of noise", report.damage.noise_px));
  if (report.damage.missing_share > 0)
    damage.push_back(
        fmt::format("{:g} % of the joints missing", 100 * report.damage.missing_share));
  if (report.damage.hidden_s > 0)
    damage.push_back(fmt::format("an arm hidden for {:g} s", report.damage.hidden_s));
  if (!damage.empty())
    list.push_back(
        {Kind::note, fmt::format("The 2D tracks were damaged before any method saw them: "
                                 "{}.",
                                 fmt::join(damage, ", "))});
  if (report.fit == "track")  // a format, as GCC 12 sees an overrun in the bare literal
    list.push_back(
        {Kind::note,
         fmt::format("Every method's answer, the simpler ones' too, was fitted to the 2D "
                     "track: a report without the fit shows the methods' own answers.")});
}

}  // namespace

std::vector<Verdict> verdicts(const EvaluationReport& report) {
  std::vector<Verdict> list;
  const std::vector<MethodReport> methods = overall_methods(report);
  if (methods.empty()) return list;
  const ClipScore& answer = answer_of(methods).mean;
  add_training_warning(list, report);
  add_known_people(list, report);
  add_treatment(list, report);
  for (std::size_t i = 1; i < methods.size(); ++i)
    if (methods[i].name != kMeanField) list.push_back(against(report, answer, methods[i]));
  add_flat_warning(list, answer, methods, report.fit == "track");
  if (report.actions.size() > 1)
    for (const ActionReport& action : report.actions) add_action_losses(list, action);
  add_foot_slide(list, answer);
  add_uncertainty(list, report.joints);
  for (const ActionReport& action : report.actions) {
    add_samples(list, action);
    add_likeness(list, action);
  }
  return list;
}

}  // namespace mcdbn
