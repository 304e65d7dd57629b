#include "mcdbn/training/joint_fine_tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "mcdbn/device/units.hpp"
#include "mcdbn/errors.hpp"
#include "mcdbn/motion/clip.hpp"
#include "mcdbn/motion/standardizer.hpp"
#include "mcdbn/training/divergence_guard.hpp"
#include "mcdbn/training/people_count.hpp"
#include "mcdbn/training/window_loss.hpp"
#include "mcdbn/training/window_sampler.hpp"

namespace mcdbn {
namespace {

/// 193 is WindowSampler's.
enum RandomStream : std::uint16_t { kViewStream = 192, kDropoutStream = 194, kStartStream };

/// Mini-batches between two reports.
constexpr std::size_t kReportEvery = 25;
/// The other direction takes part in every so many mini-batches, with as many times its weight.
constexpr std::size_t kReverseEvery = 4;

/// Of the loss, whose parts start near 1: errors that explode through time are cut here.
constexpr float kLongestGradient = 1.0F;

/// Adam's rate: rises over the first steps, then falls along a cosine.
double rate_at(double rate, std::size_t step, std::size_t steps) {
  constexpr double kRise = 30.0, kEnd = 0.02;
  const double progress = static_cast<double>(step) / static_cast<double>(steps);
  const double fall = kEnd + (1.0 - kEnd) * 0.5 * (1.0 + std::cos(std::numbers::pi * progress));
  return rate * fall * std::min(1.0, static_cast<double>(step + 1) / kRise);
}

/// Frames that either direction's up-pass needs before the first it can judge.
std::size_t longest_history(const Mcdbn& network) {
  return std::max(network.track.total_order(), network.pose.total_order());
}

/// Both directions, their losses, and what a mini-batch of them needs.
class JointTrainer {
 public:
  JointTrainer(Device& device, const Mcdbn& start, const TrainingSet& views,
               const JointWindows& windows, const TrainingConfig& config)
      : settings_(config.joint),
        seed_(config.seed),
        windows_(windows),
        network_(device, start, settings_.mean_field_steps),
        tracks_(Sequences::from_host(device, views.tracks)),
        poses_(Sequences::from_host(device, views.poses)),
        sampler_(views, windows, config),
        forward_(network_, Modality::track, windows),
        reverse_(network_, Modality::pose, windows),
        pose_loss_(device, views.modalities, windows,
                   {1.0, settings_.places, settings_.velocities}),
        track_loss_(device, windows, settings_.reverse * static_cast<double>(kReverseEvery)),
        pose_target_(device, windows.rows(), poses_.values.columns()),
        track_target_(device, windows.rows(), tracks_.values.columns()),
        index_(device, sampler_.rows(0)) {}

  void step(std::size_t step) {
    Device& device = network_.device();
    index_.upload(device, sampler_.rows(step));
    const Rows pose = Rows::indexed(poses_.values, index_, 0, windows_.rows());
    const Rows track = Rows::indexed(tracks_.values, index_, windows_.rows(), windows_.rows());
    const auto kept = static_cast<float>(1.0 - settings_.dropout);
    const RandomKey key{seed_, static_cast<std::uint32_t>(step), kDropoutStream, 0};
    network_.clear_gradients();
    gather(pose, pose_target_);
    forward_.forward(track, kept, key);
    pose_loss_.differentiate(forward_.prediction(), pose_target_, forward_.prediction_error());
    forward_.backward();
    if (settings_.reverse > 0 && step % kReverseEvery == 0) {
      gather(track, track_target_);
      RandomKey other = key;
      other.phase = 0x100;
      reverse_.forward(pose, kept, other);
      track_loss_.differentiate(reverse_.prediction(), track_target_, reverse_.prediction_error());
      reverse_.backward();
    }
    AdamRule rule;
    rule.rate = static_cast<float>(rate_at(settings_.rate, step, settings_.steps));
    rule.beta2 = 0.99F;
    rule.weight_decay = static_cast<float>(settings_.weight_decay);
    // A young average is that of few steps.
    const double young = static_cast<double>(step + 1) / static_cast<double>(step + 10);
    network_.update(rule, kLongestGradient, static_cast<float>(std::min(settings_.average, young)));
  }

  /// The weighted loss since the last call.
  double read_loss() {
    const auto parts = pose_loss_.read_and_reset();
    return parts[0] + settings_.places * parts[1] + settings_.velocities * parts[2];
  }

  Mcdbn result() { return network_.averaged(); }

 private:
  const JointSettings& settings_;
  std::uint64_t seed_;
  JointWindows windows_;
  JointNetwork network_;
  Sequences tracks_, poses_;
  WindowSampler sampler_;
  JointPass forward_, reverse_;
  PoseLoss pose_loss_;
  FeatureLoss track_loss_;
  Matrix pose_target_, track_target_;
  IndexBuffer index_;
};

/// Fewer views of much data: it varies by itself, and all views are kept in memory.
std::size_t views_that_fit(const std::vector<std::filesystem::path>& files,
                           const ClipOptions& options, const TrainingConfig& config) {
  constexpr double kMostFrames = 200'000;
  double frames = 0;
  for (const auto& file : files) {
    const Motion raw = load_clip(file, options);
    frames += static_cast<double>(raw.frames()) * raw.frame_time_s * config.fps;
  }
  const double fitting = std::max(1.0, std::floor(kMostFrames / std::max(frames, 1.0)));
  return std::min(config.augment.views, static_cast<std::size_t>(fitting));
}

}  // namespace

TrainingSet make_augmented_views(const std::vector<std::filesystem::path>& files,
                                 const Modalities& modalities, const TrainingConfig& config) {
  const ClipOptions options{.fps = 0, .keep_first_frame = config.keep_first_frame};
  const std::size_t count = views_that_fit(files, options, config);
  TrainingSet views{modalities, {}, {}, {}, {}};
  PeopleCount people;
  RandomKey key{config.seed, 0, kViewStream, 0};
  for (const auto& file : files) {
    const Motion raw = load_clip(file, options);
    const std::size_t person = people.number_of(raw.skeleton);
    for (std::size_t i = 0; i < count; ++i, ++key.step) {
      views.people.push_back(person);
      const AugmentedView view =
          augmented_view(raw, config.fps, config.camera, config.augment, key);
      // Limbs out of sight: as Mcdbn::fills_gaps says.
      views.tracks.push_back(at_mean_where_unknown(modalities.encode_track(view.track)));
      views.poses.push_back(modalities.encode_pose(view.motion, view.camera.camera_from_world));
    }
  }
  return views;
}

Mcdbn train_joint(Device& device, const Mcdbn& start, const TrainingSet& views,
                  const TrainingConfig& config, const EpochObserver& observer) {
  const JointSettings& settings = config.joint;
  JointWindows windows;
  windows.count = settings.windows;
  windows.first = longest_history(start);
  windows.lead = windows.first + settings.settle_frames;
  windows.frames = windows.lead + settings.window_frames;
  JointTrainer trainer(device, start, views, windows, config);
  DivergenceGuard guard("joint", fmt::format("lower --joint-rate (now {:g})", settings.rate));
  auto last = std::chrono::steady_clock::now();
  for (std::size_t step = 0; step < settings.steps; ++step) {
    trainer.step(step);
    const std::size_t done = step + 1;
    if (done % kReportEvery != 0 && done != settings.steps) continue;
    const double loss = trainer.read_loss();
    guard.check(done, loss);
    const auto now = std::chrono::steady_clock::now();
    EpochReport report;
    report.stage = "joint";
    report.epoch = done;
    report.epochs = settings.steps;
    report.loss = loss;
    report.windows_per_s = static_cast<double>(kReportEvery * settings.windows) /
                           std::chrono::duration<double>(now - last).count();
    report.stage_progress = static_cast<double>(done) / static_cast<double>(settings.steps);
    report.overall_progress = report.stage_progress;
    last = now;
    if (observer) observer(report);
  }
  return trainer.result();
}

namespace {

void take_size(MatrixF& weights, const MatrixF& like) {
  const float norm = weights.norm();
  if (norm > 0.0F) weights *= like.norm() / norm;
}

}  // namespace

Mcdbn sized_for_joint_stage(Device& device, const Mcdbn& greedy, const TrainingConfig& config) {
  const Mcdbn sizes = random_start(device, greedy.track.layers.front().shape().visible,
                                   greedy.pose.layers.front().shape().visible, config);
  MrbmParameters mrbm = centered(greedy.mrbm.to_host());
  const MrbmParameters mrbm_sizes = sizes.mrbm.to_host();
  for (std::size_t m = 0; m < 2; ++m) take_size(mrbm.W[m], mrbm_sizes.W[m]);
  Mcdbn network{{}, {}, Mrbm(device, uncentered(mrbm)), greedy.look_ahead, greedy.mean_field_steps};
  for (const Modality modality : {Modality::track, Modality::pose}) {
    const Cdbn& from = greedy.cdbn(modality);
    for (std::size_t i = 0; i < from.layers.size(); ++i) {
      CrbmParameters layer = centered(from.layers[i].to_host());
      const CrbmParameters size = sizes.cdbn(modality).layers[i].to_host();
      take_size(layer.W, size.W);
      take_size(layer.A, size.A);
      take_size(layer.B, size.B);
      network.cdbn(modality).layers.emplace_back(device, uncentered(layer));
    }
  }
  return network;
}

Mcdbn random_start(Device& device, std::size_t track, std::size_t pose,
                   const TrainingConfig& config) {
  // Units about zero have a slope of a quarter: with this weight a unit says again what the one
  // beneath it says. So a deep stack starts as a shallow one that its upper layers merely pass on:
  // after 250 mini-batches the loss is a tenth smaller than with all of it drawn at full size.
  constexpr float kPassOn = 4.0F;
  // The mean field hears this modality again in every step.
  constexpr float kPassOnAgain = 2.0F;
  std::uint32_t next = 0;
  // Deviations that keep a unit's input near one size, whatever its inputs' number.
  const auto layer = [&](std::size_t visible, VisibleKind kind) {
    const CrbmShape shape{visible, config.hidden, config.order, kind};
    CrbmParameters drawn =
        CrbmParameters::random(shape, 1.0, {config.seed, next++, kStartStream, 0});
    const bool lowest = kind == VisibleKind::gaussian;
    const double up = (lowest ? 0.8 : 1.0) / std::sqrt(static_cast<double>(visible));
    const double history =
        1.0 / std::sqrt(static_cast<double>(std::max<std::size_t>(config.order, 1) * visible));
    drawn.W *= static_cast<float>(up);
    drawn.B *= static_cast<float>((lowest ? 0.6 : 0.7) * history);
    drawn.A *= static_cast<float>((lowest ? 0.09 : 0.9) * history);
    if (!lowest) drawn.W.diagonal().array() += kPassOn;
    return drawn;
  };
  MrbmParameters mrbm = MrbmParameters::random(config.hidden, config.hidden, config.mrbm_hidden,
                                               1.0, {config.seed, next++, kStartStream, 0});
  const double shared = 1.0 / std::sqrt(static_cast<double>(config.hidden));
  mrbm.W[0] *= static_cast<float>(shared);
  mrbm.W[1] *= static_cast<float>(2.0 / 3.0 * shared);
  mrbm.W[0].diagonal().array() += kPassOn;
  mrbm.W[1].diagonal().array() += kPassOnAgain;
  // The mean field starts with all units of the absent modality at the same value: that must not
  // push the shared units anywhere.
  for (MatrixF& W : mrbm.W) W.rowwise() -= RowVectorF(W.colwise().mean());
  Mcdbn network{
      {}, {}, Mrbm(device, uncentered(mrbm)), config.look_ahead, config.joint.mean_field_steps};
  for (const Modality modality : {Modality::track, Modality::pose}) {
    for (std::size_t i = 0; i < config.layers; ++i) {
      CrbmParameters drawn =
          i == 0 ? layer(modality == Modality::track ? track : pose, VisibleKind::gaussian)
                 : layer(config.hidden, VisibleKind::binary);
      // The down-pass of the lowest 3D layer sums over hidden units, not over features.
      if (i == 0 && modality == Modality::pose)
        drawn.W *= static_cast<float>(
            1.5 / 0.8 * std::sqrt(static_cast<double>(pose) / static_cast<double>(config.hidden)));
      network.cdbn(modality).layers.emplace_back(device, uncentered(drawn));
    }
  }
  return network;
}

}  // namespace mcdbn
