#pragma once

#include <fmt/format.h>

#include <string>

#include "learning/small_network.hpp"
#include "mcdbn/learning/fine_tuning.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"
#include "motion_model/fine_tuning_on_views.hpp"
#include "motion_model/pose_judge.hpp"

namespace mcdbn::test {

/// A clip of a small case: frames, and who is seen.
struct SmallClip {
  Eigen::Index frames;
  std::size_t person;
};

/// A small run of fine-tuning, on the device and in double precision. Everything that either needs
/// is set here, so that both get the same.
class FineTuningCase {
 public:
  static constexpr std::size_t kTrack = 5;
  /// The setting of the network that is started from, which must not be taken over.
  static constexpr std::size_t kOtherMeanFieldSteps = 9;

  FineTuningCase(const std::vector<SmallClip>& clips,
                 const std::array<std::vector<LayerSize>, 2>& sizes, std::size_t shared)
      : parameters(random_network({kTrack, figure.dimension()}, sizes, shared, 300)),
        views{figure.modalities(), {}, {}, {}, {}, {}} {
    for (std::size_t i = 0; i < clips.size(); ++i) {
      views.poses.push_back(swaying(clips[i].frames, i));
      views.tracks.push_back(random_matrix(static_cast<std::size_t>(clips[i].frames), kTrack,
                                           40 + static_cast<unsigned>(i), 1.2F));
      views.clips.push_back({fmt::format("/clips/clip{}.bvh", i), ""});
      views.people.push_back(clips[i].person);
    }
    config.seed = 0x1234567890ULL;
    config.look_ahead = 2;
    // Settings of other stages, which must not matter here.
    config.mrbm.mean_field_steps = 6;
    config.mrbm.rate = 0.3;
    config.mrbm.weight_decay = 0.4;
    config.batch = 7;
    config.order = 5;
    config.fine_tuning.windows = 3;
    config.fine_tuning.window_frames = 5;
    config.fine_tuning.settle_frames = 2;
    config.fine_tuning.people_power = 0.3;
    config.fine_tuning.rate = 2e-2;
    config.fine_tuning.weight_decay = 0.8;
    config.fine_tuning.dropout = 0.25;
    config.fine_tuning.average = 0.4;
    config.pose_loss.positions = 0.02;
    config.pose_loss.velocities = 0.01;
    config.pose_loss.contacts = 0.02;
    config.fine_tuning.reverse = 0.15;
    config.fine_tuning.mean_field_steps = 3;
    config.hold_out_among = 0;
  }

  TrainedNetwork train(Device& device, const EpochObserver& observer = {}) const {
    return fine_tune_on_views(device, start(device), views, config, observer);
  }
  Mcdbn start(Device& device) const {
    return on_device(device, parameters, config.look_ahead, kOtherMeanFieldSteps);
  }

  reference::FineTuningSettings settings() const {
    reference::FineTuningSettings settings;
    settings.seed = config.seed;
    settings.look_ahead = config.look_ahead;
    settings.steps = config.fine_tuning.steps;
    settings.windows = config.fine_tuning.windows;
    settings.window_frames = config.fine_tuning.window_frames;
    settings.settle_frames = config.fine_tuning.settle_frames;
    settings.people_power = config.fine_tuning.people_power;
    settings.rate = config.fine_tuning.rate;
    settings.weight_decay = config.fine_tuning.weight_decay;
    settings.dropout = config.fine_tuning.dropout;
    settings.average = config.fine_tuning.average;
    settings.reverse = config.fine_tuning.reverse;
    settings.mean_field_steps = static_cast<int>(config.fine_tuning.mean_field_steps);
    return settings;
  }
  /// @param held_out who takes no part; everyone does if no person has the number
  reference::FineTuningData data_without(std::size_t held_out) const {
    return data([=](std::size_t person) { return person != held_out; });
  }
  reference::FineTuningData data_of(std::size_t one) const {
    return data([=](std::size_t person) { return person == one; });
  }
  PoseJudge judge() const {
    return {
        figure,
        {1.0, config.pose_loss.positions, config.pose_loss.velocities, config.pose_loss.contacts}};
  }
  /// @param held_out who takes no part
  reference::FineTuning in_double_without(std::size_t held_out) const {
    return {in_double(parameters), data_without(held_out), settings(), judge()};
  }
  static constexpr std::size_t kNobody = 1000;

  SmallFigure figure;
  NetworkParameters parameters;
  TrainingSet views;
  TrainingConfig config;

 private:
  /// Poses so slow that the foot now and then stands.
  MatrixF swaying(Eigen::Index frames, std::size_t clip) const {
    MatrixF pose(frames, static_cast<Eigen::Index>(figure.dimension()));
    for (Eigen::Index t = 0; t < frames; ++t)
      for (Eigen::Index c = 0; c < pose.cols(); ++c)
        pose(t, c) = static_cast<float>(0.25 * std::sin(0.15 * static_cast<double>(t) +
                                                        1.7 * static_cast<double>(c) +
                                                        0.9 * static_cast<double>(clip)));
    return pose;
  }

  template <typename Takes>
  reference::FineTuningData data(const Takes& takes) const {
    reference::FineTuningData data;
    for (std::size_t i = 0; i < views.poses.size(); ++i) {
      const std::size_t person = views.people.empty() ? 0 : views.people[i];
      if (!takes(person)) continue;
      data.tracks.push_back(views.tracks[i].cast<double>());
      data.poses.push_back(views.poses[i].cast<double>());
      data.people.push_back(person);
    }
    return data;
  }
};

/// Every matrix of a network as the reference has it. Only rounding may differ: 2^-24 of a
/// parameter in a mini-batch, and that of its gradient, of which Adam lets through what is relative
/// to its size, near 1e-5 of the way that a matrix has gone (root mean squares). What a wrong
/// schedule does to some matrix is at least a hundredth of that way.
inline void check_same_parameters(const Mcdbn& got, const reference::UnrolledModel& centered_want,
                                  const NetworkParameters& start) {
  const auto matrices = [](const reference::UnrolledModel& model) {
    std::vector<MatrixD> all;
    reference::for_each_matrix(
        model, [&](const auto& matrix, bool, const char*) { all.emplace_back(matrix); });
    return all;
  };
  const NetworkParameters parameters = on_host(got);
  const auto own = matrices(reference::centered(in_double(parameters))),
             want = matrices(centered_want), from = matrices(reference::centered(in_double(start)));
  std::vector<std::string> names;
  reference::for_each_matrix(
      centered_want, [&](const auto&, bool, const char* name) { names.emplace_back(name); });
  REQUIRE(own.size() == want.size());
  for (std::size_t i = 0; i < want.size(); ++i) {
    INFO("matrix ", i, ", ", names[i]);
    REQUIRE(own[i].rows() == want[i].rows());
    REQUIRE(own[i].cols() == want[i].cols());
    const double entries = std::sqrt(static_cast<double>(want[i].size()));
    const double error = (own[i] - want[i]).norm() / entries,
                 way = (want[i] - from[i]).norm() / entries;
    // Biases carry the rounding of their weights' sums through centering and back.
    const double rounding = 4 * 0x1p-24 * std::max(1.0, want[i].cwiseAbs().maxCoeff());
    CAPTURE(error);
    CAPTURE(way);
    CHECK(error <= 1e-4 * way + rounding);
  }
  for (std::size_t m = 0; m < 2; ++m)
    for (std::size_t i = 0; i < start.stacks[m].size(); ++i) {
      CHECK(parameters.stacks[m][i].shape == start.stacks[m][i].shape);
      CHECK((parameters.stacks[m][i].visible_mean - start.stacks[m][i].visible_mean)
                .cwiseAbs()
                .maxCoeff() <= 0x1p-23F);
    }
}

}  // namespace mcdbn::test
