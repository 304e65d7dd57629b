#include "evaluation/action_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/random_sequence.hpp"
#include "base/random_streams.hpp"
#include "evaluation/pairwise.hpp"
#include "evaluation/sample_spread.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

using Clips = std::vector<const ReportClip*>;

constexpr int kBins = 20;  // of a histogram

void check(const std::string& action, const Clips& clips) {
  if (clips.empty()) throw ShapeError(fmt::format("{}: no clip to report on", action));
  for (const ReportClip* clip : clips)
    if (clip->joints != clips[0]->joints || clip->samples.size() != clips[0]->samples.size() ||
        clip->samples.empty())
      throw ShapeError(fmt::format("{}: clip {} has {} joints and {} samples, another {} and {}",
                                   action, clip->name, clip->joints, clip->samples.size(),
                                   clips[0]->joints, clips[0]->samples.size()));
}

/// `count` of the values, each at most once, in their order (Knuth's algorithm S).
std::vector<double> drawn(const std::vector<double>& values, std::size_t count,
                          std::uint64_t seed) {
  std::vector<double> chosen;
  RandomSequence random(seed, random_streams::kDrawnPairs);
  for (std::size_t i = 0; i < values.size() && chosen.size() < count; ++i)
    if (random.below(values.size() - i) < count - chosen.size()) chosen.push_back(values[i]);
  return chosen;
}

void compare_pairs(ActionReport& report, const Clips& clips, std::uint64_t seed) {
  std::vector<MatrixD> real, regenerated;
  for (const ReportClip* clip : clips) {
    real.push_back(judged_positions(*clip, clip->truth_mm));
    for (const ReportMotion& sample : clip->samples)
      regenerated.push_back(judged_positions(*clip, sample.points_mm));
  }
  report.pairs_real = correlation_report(pairwise_pearson(real));
  report.pairs_all = correlation_report(pairwise_pearson(regenerated));
  report.pairs_drawn =
      correlation_report(drawn(report.pairs_all.values, report.pairs_real.values.size(), seed));
  const DistributionFit* of_real = report.pairs_real.weibull();
  const DistributionFit* of_regenerated = report.pairs_drawn.weibull();
  if (of_real && of_regenerated)
    report.weibull_kl = weibull_kl(weibull_of(*of_real), weibull_of(*of_regenerated));
}

void compare_methods(ActionReport& report, const Clips& clips) {
  std::vector<ClipScore> model, best;
  std::map<std::string, std::vector<ClipScore>> others;
  double diversity = 0;
  for (const ReportClip* clip : clips) {
    std::vector<MatrixD> samples;
    const ReportMotion* nearest = &clip->samples.front();
    for (const ReportMotion& sample : clip->samples) {
      model.push_back(sample.score);
      if (sample.score.error.mpjpe_mm < nearest->score.error.mpjpe_mm) nearest = &sample;
      samples.emplace_back(sample.points_mm.leftCols(3 * clip->joints));
    }
    best.push_back(nearest->score);
    diversity += diversity_mm(samples) / static_cast<double>(clips.size());
    for (const auto& [name, motion] : clip->others) others[name].push_back(motion.score);
  }
  report.model = {"model", mean_score(model)};
  for (const auto& [name, scores] : others) report.others.push_back({name, mean_score(scores)});
  if (report.samples > 1) {
    report.best = MethodReport{fmt::format("best of {}", report.samples), mean_score(best)};
    report.diversity_mm = diversity;
  }
}

}  // namespace

const DistributionFit* CorrelationReport::weibull() const {
  const auto found = std::find_if(fits.begin(), fits.end(), [](const DistributionFit& fit) {
    return fit.family == DistributionFamily::weibull;
  });
  return found == fits.end() ? nullptr : &*found;
}

CorrelationReport correlation_report(std::vector<double> values) {
  CorrelationReport report;
  report.statistics = summarize(values, kBins);
  std::vector<double> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](double value) { return std::isfinite(value); });
  report.fits = rank_distributions(
      Eigen::Map<const Eigen::VectorXd>(finite.data(), static_cast<Eigen::Index>(finite.size())));
  report.values = std::move(values);
  return report;
}

ActionReport analyse_action(const std::string& name, const Clips& clips, std::uint64_t seed) {
  check(name, clips);
  ActionReport report;
  report.name = name;
  report.clips = static_cast<int>(clips.size());
  report.samples = clips.front()->samples.size();
  std::vector<double> flat, channel;
  for (const ReportClip* clip : clips) {
    report.frames += clip->frames();
    report.trained_clips += clip->trained_on;
    for (const ReportMotion& sample : clip->samples) {
      flat.push_back(sample.score.pcc_flat);
      channel.push_back(sample.score.pcc_channel);
    }
  }
  report.flat = correlation_report(std::move(flat));
  report.channel = correlation_report(std::move(channel));
  compare_pairs(report, clips, seed);
  compare_methods(report, clips);
  return report;
}

std::vector<ActionReport> analyse_actions(const std::vector<ReportClip>& clips, std::uint64_t seed,
                                          const ReportProgress& progress) {
  std::vector<std::string> names;
  for (const ReportClip& clip : clips)
    if (std::find(names.begin(), names.end(), clip.action) == names.end())
      names.push_back(clip.action);
  std::vector<ActionReport> reports;
  for (const std::string& name : names) {
    if (progress)
      progress(fmt::format("statistics of {}", name),
               static_cast<double>(reports.size()) / static_cast<double>(names.size()));
    Clips chosen;
    for (const ReportClip& clip : clips)
      if (clip.action == name) chosen.push_back(&clip);
    reports.push_back(analyse_action(name, chosen, seed));
  }
  return reports;
}

}  // namespace mcdbn
