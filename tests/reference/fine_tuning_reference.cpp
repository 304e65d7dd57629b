#include "reference/fine_tuning_reference.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "mcdbn/base/random.hpp"

namespace mcdbn::reference {
namespace {

/// Every random stream of fine-tuning: what draws what.
constexpr std::uint16_t kWindowStream = 193, kDropOutStream = 194;
constexpr std::size_t kReverseEvery = 4;
constexpr std::uint16_t kReversePhase = 0x100;
constexpr double kLongestGradient = 1.0;
constexpr double kRise = 30.0, kLastRate = 0.02;
constexpr double kBeta1 = 0.9, kBeta2 = 0.99, kEpsilon = 1e-8;

Eigen::Index total_order(const std::vector<Crbm>& stack) {
  Eigen::Index order = 0;
  for (const Crbm& layer : stack)
    order +=
        std::max(layer.visible_history.rows(), layer.hidden_history.rows()) / layer.weights.rows();
  return order;
}

WindowLayout layout_of(const UnrolledModel& model, const FineTuningSettings& settings) {
  WindowLayout layout;
  layout.count = static_cast<Eigen::Index>(settings.windows);
  layout.first = std::max(total_order(model.stacks[0]), total_order(model.stacks[1]));
  layout.judged_from = layout.first + static_cast<Eigen::Index>(settings.settle_frames);
  layout.frames = layout.judged_from + static_cast<Eigen::Index>(settings.window_frames);
  return layout;
}

/// Which clip a draw in (0, 1) means: clips weigh their frames times (their person's frames)^(power
/// − 1).
std::size_t drawn_clip(const FineTuningData& data, double power, double uniform) {
  std::map<std::size_t, double> frames_of;
  const auto person = [&](std::size_t i) { return data.people.empty() ? 0 : data.people[i]; };
  for (std::size_t i = 0; i < data.poses.size(); ++i)
    frames_of[person(i)] += static_cast<double>(data.poses[i].rows());
  std::vector<double> weights;
  double all = 0;
  for (std::size_t i = 0; i < data.poses.size(); ++i) {
    weights.push_back(static_cast<double>(data.poses[i].rows()) *
                      std::pow(frames_of[person(i)], power - 1.0));
    all += weights.back();
  }
  double left = uniform * all;
  for (std::size_t i = 0; i + 1 < weights.size(); ++i) {
    if (left < weights[i]) return i;
    left -= weights[i];
  }
  return weights.size() - 1;
}

double rate_at(const FineTuningSettings& settings, std::size_t step) {
  const double angle =
      std::numbers::pi * static_cast<double>(step) / static_cast<double>(settings.steps);
  const double fall = kLastRate + (1.0 - kLastRate) * (1.0 + std::cos(angle)) / 2.0;
  const double rise = std::min(static_cast<double>(step + 1) / kRise, 1.0);
  return settings.rate * fall * rise;
}

}  // namespace

Judgement mean_squared(const WindowLayout& layout, const MatrixD& prediction, const MatrixD& target,
                       double weight) {
  Judgement judged{0, MatrixD::Zero(prediction.rows(), prediction.cols())};
  const double count =
      static_cast<double>(layout.count * (layout.frames - layout.judged_from) * prediction.cols());
  for (Eigen::Index row = 0; row < prediction.rows(); ++row) {
    if (row % layout.frames < layout.judged_from) continue;
    const RowVectorD difference = prediction.row(row) - target.row(row);
    judged.loss += weight * difference.squaredNorm() / count;
    judged.error.row(row) = 2.0 * weight / count * difference;
  }
  return judged;
}

DrawnWindows drawn_windows(const FineTuningData& data, const WindowLayout& layout,
                           const FineTuningSettings& settings, std::size_t step) {
  const RandomKey key{settings.seed, static_cast<std::uint32_t>(step), kWindowStream, 0};
  const Eigen::Index rows = layout.count * layout.frames;
  DrawnWindows drawn{MatrixD(rows, data.tracks[0].cols()), MatrixD(rows, data.poses[0].cols())};
  for (Eigen::Index i = 0; i < layout.count; ++i) {
    const auto row = static_cast<std::uint32_t>(i);
    const std::size_t clip =
        drawn_clip(data, settings.people_power, double{random_uniform(key, row, 0)});
    const Eigen::Index frames = data.poses[clip].rows();
    const Eigen::Index starts =
        std::max<Eigen::Index>(frames - (layout.frames - layout.judged_from), 0);
    Eigen::Index first_judged = 0;
    if (random_uniform(key, row, 1) >= 0.1F)
      first_judged = static_cast<Eigen::Index>(
          std::floor(static_cast<double>(starts + 1) * double{random_uniform(key, row, 2)}));
    for (Eigen::Index t = 0; t < layout.frames; ++t) {
      const Eigen::Index frame = first_judged - layout.judged_from + t;
      const auto within = [&](Eigen::Index at) {
        return std::clamp<Eigen::Index>(at, 0, frames - 1);
      };
      drawn.pose.row(i * layout.frames + t) = data.poses[clip].row(within(frame));
      drawn.track.row(i * layout.frames + t) =
          data.tracks[clip].row(within(frame + static_cast<Eigen::Index>(settings.look_ahead)));
    }
  }
  return drawn;
}

DropOut drawn_drop_out(const UnrolledModel& model, int present, const FineTuningSettings& settings,
                       std::size_t step, std::uint16_t first_phase, std::uint32_t window) {
  if (settings.dropout == 0) return {};
  const auto kept = static_cast<float>(1.0 - settings.dropout);
  RandomKey key{settings.seed, static_cast<std::uint32_t>(step), kDropOutStream, first_phase};
  const auto draw = [&](Eigen::Index units) {
    ++key.phase;
    RowVectorD factors(units);
    for (Eigen::Index c = 0; c < units; ++c)
      factors[c] =
          random_uniform(key, window, static_cast<std::uint32_t>(c)) < kept ? 1.0 / kept : 0.0;
    return factors;
  };
  const auto p = static_cast<std::size_t>(present);
  const std::vector<Crbm>& down = model.stacks[1 - p];
  DropOut drop_out;
  for (const Crbm& layer : model.stacks[p]) drop_out.up.push_back(draw(layer.hidden_bias.size()));
  drop_out.shared = draw(model.mrbm.hidden_bias.size());
  drop_out.down.resize(down.size());
  for (std::size_t i = down.size(); i-- > 0;) {
    drop_out.down[i] = draw(down[i].visible_bias.size());
    if (down[i].visible_units == VisibleUnits::gaussian) drop_out.down[i].resize(0);
  }
  return drop_out;
}

FineTuning::FineTuning(const UnrolledModel& start, FineTuningData data,
                       const FineTuningSettings& settings, Judge judge_pose)
    : settings_(settings),
      data_(std::move(data)),
      judge_pose_(std::move(judge_pose)),
      shape_(centered(start)),
      layout_(layout_of(start, settings)) {
  value_ = average_ = shape_.flattened();
  mean_ = square_ = Eigen::VectorXd::Zero(value_.size());
  UnrolledModel marks = shape_;
  for_each_matrix(marks, [](auto& matrix, bool weight, const char*) {
    matrix.setConstant(weight ? 1.0 : 0.0);
  });
  is_weight_ = marks.flattened();
}

Eigen::VectorXd FineTuning::gradient(double& loss) const {
  const UnrolledModel model = shape_.with_parameters(value_);
  UnrolledModel sum = shape_.with_parameters(Eigen::VectorXd::Zero(value_.size()));
  const DrawnWindows drawn = drawn_windows(data_, layout_, settings_, done_);
  const auto one_direction = [&](int present, std::uint16_t phase, const Judge& judge) {
    const MatrixD& input = present == 0 ? drawn.track : drawn.pose;
    const MatrixD& target = present == 0 ? drawn.pose : drawn.track;
    std::vector<UnrolledGradient> windows;
    MatrixD prediction(target.rows(), target.cols());
    for (Eigen::Index i = 0; i < layout_.count; ++i) {
      windows.emplace_back(
          model, present, input.middleRows(i * layout_.frames, layout_.frames),
          static_cast<int>(layout_.first), settings_.mean_field_steps,
          drawn_drop_out(model, present, settings_, done_, phase, static_cast<std::uint32_t>(i)));
      prediction.middleRows(i * layout_.frames, layout_.frames) = windows.back().prediction();
    }
    const Judgement judged = judge(layout_, prediction, target);
    for (Eigen::Index i = 0; i < layout_.count; ++i)
      windows[static_cast<std::size_t>(i)].add_to(
          sum, judged.error.middleRows(i * layout_.frames, layout_.frames));
    return judged.loss;
  };
  loss = one_direction(0, 0, judge_pose_);
  if (settings_.reverse > 0 && done_ % kReverseEvery == 0)
    one_direction(1, kReversePhase,
                  [&](const WindowLayout& layout, const MatrixD& got, const MatrixD& want) {
                    return mean_squared(layout, got, want, kReverseEvery * settings_.reverse);
                  });
  return sum.flattened();
}

double FineTuning::step() {
  double loss = 0;
  Eigen::VectorXd by_parameters = gradient(loss);
  gradient_length_ = by_parameters.norm();
  if (gradient_length_ > kLongestGradient) by_parameters *= kLongestGradient / gradient_length_;
  learn(by_parameters);
  ++done_;
  return loss;
}

void FineTuning::learn(const Eigen::VectorXd& gradient) {
  const auto count = static_cast<double>(done_ + 1);
  mean_ = kBeta1 * mean_ + (1.0 - kBeta1) * gradient;
  square_ = kBeta2 * square_ + (1.0 - kBeta2) * gradient.cwiseAbs2();
  const Eigen::VectorXd corrected_mean = mean_ / (1.0 - std::pow(kBeta1, count)),
                        corrected_square = square_ / (1.0 - std::pow(kBeta2, count));
  const Eigen::ArrayXd direction =
      corrected_mean.array() / (corrected_square.array().sqrt() + kEpsilon);
  const Eigen::ArrayXd decay = settings_.weight_decay * is_weight_.array() * value_.array();
  value_.array() -= rate_at(settings_, done_) * (direction + decay);
  const double kept = std::min(settings_.average, count / (count + 9.0));
  average_ = kept * average_ + (1.0 - kept) * value_;
}

double FineTuning::loss_on(const FineTuningData& others) const {
  const UnrolledModel model = averaged();
  constexpr std::size_t kBatches = 4;
  double sum = 0;
  for (std::size_t batch = 0; batch < kBatches; ++batch) {
    const DrawnWindows drawn = drawn_windows(others, layout_, settings_, batch);
    MatrixD prediction(drawn.pose.rows(), drawn.pose.cols());
    for (Eigen::Index i = 0; i < layout_.count; ++i)
      prediction.middleRows(i * layout_.frames, layout_.frames) =
          UnrolledGradient(model, 0, drawn.track.middleRows(i * layout_.frames, layout_.frames),
                           static_cast<int>(layout_.first), settings_.mean_field_steps, {})
              .prediction();
    sum += judge_pose_(layout_, prediction, drawn.pose).loss;
  }
  return sum / kBatches;
}

}  // namespace mcdbn::reference
