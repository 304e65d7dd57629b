#include "evaluation/evaluation_report.hpp"

#include <cmath>
#include <map>

namespace mcdbn {
namespace {

using nlohmann::ordered_json;

/// JSON has no NaN.
ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json score_json(const ClipScore& score) {
  ordered_json json = ordered_json::object();
  for (const ScoreFigure& figure : score_figures()) json[figure.name] = number(figure.of(score));
  json["foot_slide_of_truth_mm_s"] = number(score.foot_slide.truth_mm_s);
  return json;
}

ordered_json track_json(const TrackError& error) {
  return {{"track_error_px", number(error.track_error_px)},
          {"mean_track_error_px", number(error.mean_track_error_px)}};
}

ordered_json statistics_json(const SummaryStatistics& statistics) {
  return {{"count", statistics.count},
          {"left_out", statistics.left_out},
          {"mean", number(statistics.mean)},
          {"standard_deviation", number(statistics.standard_deviation)},
          {"mode", number(statistics.mode)},
          {"median", number(statistics.median)},
          {"minimum", number(statistics.minimum)},
          {"maximum", number(statistics.maximum)},
          {"histogram",
           {{"low", statistics.histogram.low},
            {"high", statistics.histogram.high},
            {"counts", statistics.histogram.counts}}}};
}

ordered_json fit_json(const DistributionFit& fit) {
  ordered_json json = {{"family", family_name(fit.family)},
                       {"aic", number(fit.aic())},
                       {"bic", number(fit.bic())},
                       {"parameters", ordered_json::object()}};
  for (const FittedParameter& parameter : fit.parameters) {
    ordered_json& entry = json["parameters"][parameter.name];
    entry = {{"value", number(parameter.value)},
             {"standard_error", number(parameter.standard_error)}};
    if (fit.family == DistributionFamily::weibull) {
      const Interval interval = confidence_95(parameter);
      entry["low_95"] = number(interval.low);
      entry["high_95"] = number(interval.high);
    }
  }
  return json;
}

ordered_json correlation_json(const CorrelationReport& correlations) {
  ordered_json json = statistics_json(correlations.statistics);
  json["fits"] = ordered_json::array();
  for (const DistributionFit& fit : correlations.fits) json["fits"].push_back(fit_json(fit));
  return json;
}

ordered_json action_json(const ActionReport& action) {
  ordered_json json = {{"name", action.name},       {"clips", action.clips},
                       {"frames", action.frames},   {"training_clips", action.trained_clips},
                       {"samples", action.samples}, {"model", score_json(action.model.mean)}};
  for (const MethodReport& other : action.others)
    json[other.name == kMeanField ? "model_mean_field" : "baselines"] = ordered_json::object();
  for (const MethodReport& other : action.others)
    (other.name == kMeanField ? json["model_mean_field"] : json["baselines"][other.name]) =
        score_json(other.mean);
  if (action.best) json["best_of_samples"] = score_json(action.best->mean);
  if (action.diversity_mm) json["diversity_mm"] = number(*action.diversity_mm);
  json["pcc_flat"] = correlation_json(action.flat);
  json["pcc_channel"] = correlation_json(action.channel);
  json["pairwise_real"] = correlation_json(action.pairs_real);
  json["pairwise_regenerated"] = correlation_json(action.pairs_all);
  json["pairwise_regenerated_drawn"] = correlation_json(action.pairs_drawn);
  json["weibull_kl_nats"] = action.weibull_kl ? number(*action.weibull_kl) : ordered_json(nullptr);
  return json;
}

ordered_json clip_json(const ReportClip& clip) {
  std::vector<ClipScore> scores;
  for (const ReportMotion& sample : clip.samples) scores.push_back(sample.score);
  ordered_json json = {{"name", clip.name},
                       {"action", clip.action},
                       {"trained_on", clip.trained_on},
                       {"frames", clip.frames()},
                       {"fps", clip.fps},
                       {"model", score_json(mean_score(scores))},
                       {"track_from_pose", track_json(clip.track)}};
  return json;
}

const char* kind_name(Verdict::Kind kind) {
  return kind == Verdict::Kind::good ? "good" : kind == Verdict::Kind::bad ? "bad" : "note";
}

}  // namespace

std::vector<MethodReport> overall_methods(const EvaluationReport& report) {
  if (report.clips.empty()) return {};
  std::vector<ClipScore> model;
  std::map<std::string, std::vector<ClipScore>> others;
  for (const ReportClip& clip : report.clips) {
    for (const ReportMotion& sample : clip.samples) model.push_back(sample.score);
    for (const auto& [name, motion] : clip.others) others[name].push_back(motion.score);
  }
  std::vector<MethodReport> methods = {{"model", mean_score(model)}};
  for (const auto& [name, scores] : others) methods.push_back({name, mean_score(scores)});
  return methods;
}

TrackError overall_track_error(const EvaluationReport& report) {
  TrackError mean;
  const auto clips = static_cast<double>(report.clips.size());
  for (const ReportClip& clip : report.clips) {
    mean.track_error_px += clip.track.track_error_px / clips;
    mean.mean_track_error_px += clip.track.mean_track_error_px / clips;
  }
  return mean;
}

ordered_json summary_json(const EvaluationReport& report) {
  int frames = 0, trained = 0;
  for (const ReportClip& clip : report.clips) {
    frames += clip.frames();
    trained += clip.trained_on;
  }
  ordered_json json = {{"clips", report.clips.size()}, {"frames", frames}};
  ordered_json baselines = ordered_json::object(), mean_field;
  for (const MethodReport& method : overall_methods(report)) {
    if (method.name == "model")
      json["model"] = score_json(method.mean);
    else
      (method.name == kMeanField ? mean_field : baselines[method.name]) = score_json(method.mean);
  }
  json["baselines"] = std::move(baselines);
  if (!mean_field.is_null()) json["model_mean_field"] = std::move(mean_field);
  json["track_from_pose"] = track_json(overall_track_error(report));
  for (const auto& [name, coverage] :
       {std::pair("joints", &report.joints), {"channels", &report.channels}})
    if (!coverage->empty()) json["coverage"][name] = coverage_json(*coverage);
  json["model_file"] = report.model;
  json["protocol"] = report.protocol;
  json["temperature"] = report.temperature;
  json["fit"] = report.fit;
  json["tracks"] = report.tracks;
  json["camera_known"] = report.camera_known;
  json["track_damage"] = {{"noise_px", report.damage.noise_px},
                          {"missing_share", report.damage.missing_share},
                          {"hidden_s", report.damage.hidden_s}};
  json["samples"] = report.clips.empty() ? 0 : report.clips.front().samples.size();
  json["training_clips"] = trained;
  json["verdicts"] = ordered_json::array();
  for (const Verdict& verdict : verdicts(report))
    json["verdicts"].push_back({{"kind", kind_name(verdict.kind)}, {"text", verdict.text}});
  json["actions"] = ordered_json::array();
  for (const ActionReport& action : report.actions) json["actions"].push_back(action_json(action));
  json["per_clip"] = ordered_json::array();
  for (const ReportClip& clip : report.clips) json["per_clip"].push_back(clip_json(clip));
  return json;
}

}  // namespace mcdbn
