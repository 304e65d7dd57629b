// The multimodal DBM's stages against double precision with their own draws, and what it can learn.

#include "comparison/multimodal_dbm.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "comparison/clips.hpp"
#include "comparison/constant_pose.hpp"
#include "comparison/dbm_training.hpp"
#include "comparison/track_window.hpp"
#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/units_reference.hpp"

namespace multimodal_dbm_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::sigmoid;

namespace {

const BimodalShape kShape{{3, 2}, {3, 2}, 2};

MatrixD drawn(const MatrixD& probability, const RandomKey& key) {
  MatrixD units(probability.rows(), probability.cols());
  for (Eigen::Index r = 0; r < units.rows(); ++r)
    for (Eigen::Index c = 0; c < units.cols(); ++c)
      units(r, c) =
          static_cast<double>(random_uniform(key, static_cast<std::uint32_t>(r),
                                             static_cast<std::uint32_t>(c))) < probability(r, c)
              ? 1.0
              : 0.0;
  return units;
}

/// A machine of some parameters, data of one mini-batch, and the settings of a training.
struct Scene {
  explicit Scene(Device& device) : machine(device, kShape, {1, 0, 9, 0}) {
    Parameters parameters = machine.parameters();
    unsigned seed = 20;
    for (const auto& entry : parameters.entries())
      parameters.upload(entry.name, 0.7F * random_clip(static_cast<int>(entry.rows),
                                                       static_cast<int>(entry.columns), seed++));
    machine.refresh_transposed();
    settings.batch = 6;
    settings.least_batches = 1;
    settings.mean_field_steps = 4;
    settings.gibbs_sweeps = 2;
  }
  MatrixD get(const std::string& name) const {
    return machine.parameters().to_host(name).cast<double>();
  }
  MatrixD get(const char* letter, std::size_t m) const {
    return get(std::string(letter) + (m == 0 ? "_track" : "_pose"));
  }

  DbmMachine machine;
  MultimodalDbmSettings settings;
  std::array<MatrixF, 2> data = {random_clip(6, 3, 1), random_clip(6, 2, 2)};
};

double off(const Parameters& gradients, const std::string& name, const MatrixD& want) {
  return (gradients.to_host(name).cast<double>() - want).cwiseAbs().maxCoeff();
}

/// A slow motion that the pose follows along lines.
void add_clip(std::vector<MatrixF>& tracks, std::vector<MatrixF>& poses, int frames, float phase) {
  MatrixF track(frames, 2), pose(frames, 3);
  for (int t = 0; t < frames; ++t) {
    const float at = 0.15F * static_cast<float>(t) + phase;
    track.row(t) << 1.4F * std::sin(at), 1.4F * std::cos(at);
    pose.row(t) << 1.4F * std::cos(at), -1.4F * std::sin(at), std::sin(at) + std::cos(at);
  }
  tracks.push_back(track);
  poses.push_back(pose);
}

double error_of(const MatrixF& got, const MatrixF& want) {
  return static_cast<double>((got - want).squaredNorm()) / static_cast<double>(want.size());
}

}  // namespace

TEST_CASE("multimodal DBM: a modality's layer learns by CD-1, what comes from below doubled") {
  on_every_device([](Device& device) {
    Scene scene(device);
    DbmTraining training(scene.machine, scene.settings, scene.data, OptimizerKind::none);
    const RandomKey key{4, 7, 9, 0};
    for (std::size_t m = 0; m < 2; ++m) {
      const std::string modality = m == 0 ? "_track" : "_pose";
      const MatrixD W = scene.get("W", m), v = scene.data[m].cast<double>();
      const RowVectorD a = scene.get("a", m).row(0), b = scene.get("b", m).row(0);
      const MatrixD h = sigmoid((2 * v * W).rowwise() + b);
      const MatrixD back = (drawn(h, key) * W.transpose()).rowwise() + a;
      const MatrixD h_back = sigmoid((2 * back * W).rowwise() + b);
      training.learn_pathway(m, 0, 0.1F, key);
      const Parameters gradients = training.gradients();
      CHECK(off(gradients, "W" + modality, (back.transpose() * h_back - v.transpose() * h) / 6) <
            1e-5);
      CHECK(off(gradients, "a" + modality, (back - v).colwise().mean()) < 1e-5);
      CHECK(off(gradients, "b" + modality, (h_back - h).colwise().mean()) < 1e-5);
    }
  });
}

TEST_CASE("multimodal DBM: the joint layer learns by CD-1, what comes from above doubled") {
  on_every_device([](Device& device) {
    Scene scene(device);
    DbmTraining training(scene.machine, scene.settings, scene.data, OptimizerKind::none);
    const RandomKey key{4, 7, 9, 0};
    std::array<MatrixD, 2> h, back;
    const RowVectorD c = scene.get("c").row(0);
    for (std::size_t m = 0; m < 2; ++m)
      h[m] = sigmoid((2 * scene.data[m].cast<double>() * scene.get("W", m)).rowwise() +
                     RowVectorD(scene.get("b", m).row(0)));
    const auto joint = [&](const std::array<MatrixD, 2>& hidden) {
      return sigmoid((hidden[0] * scene.get("U", 0) + hidden[1] * scene.get("U", 1)).rowwise() + c);
    };
    const MatrixD z = joint(h);
    for (std::size_t m = 0; m < 2; ++m)
      back[m] = sigmoid((2 * drawn(z, key) * scene.get("U", m).transpose()).rowwise() +
                        RowVectorD(scene.get("b", m).row(0)));
    const MatrixD z_back = joint(back);
    training.learn_joint_layer(0, 0.1F, key);
    const Parameters gradients = training.gradients();
    for (std::size_t m = 0; m < 2; ++m) {
      const std::string modality = m == 0 ? "_track" : "_pose";
      CHECK(off(gradients, "U" + modality,
                (back[m].transpose() * z_back - h[m].transpose() * z) / 6) < 1e-5);
      CHECK(off(gradients, "b" + modality, (back[m] - h[m]).colwise().mean()) < 1e-5);
    }
    CHECK(off(gradients, "c", (z_back - z).colwise().mean()) < 1e-5);
  });
}

TEST_CASE("multimodal DBM: joint training sets mean field on the data against chains that go on") {
  on_every_device([](Device& device) {
    Scene scene(device);
    DbmTraining training(scene.machine, scene.settings, scene.data, OptimizerKind::none);
    DbmMachine::Units data(device, kShape, 6), chains(device, kShape, 6);
    for (std::size_t m = 0; m < 2; ++m) data.visible[m].upload(scene.data[m]);
    scene.machine.mean_field(data, DbmMachine::kNoneAbsent, 4);
    for (std::uint32_t step = 0; step < 2; ++step) {  // the second goes on where the first ended
      CAPTURE(step);
      training.learn_all(0, 0.1F, {4, step, 9, 0});
      scene.machine.gibbs_sweep(chains, {4, step, 9, 0});
      scene.machine.gibbs_sweep(chains, {4, step, 9, 5});
      for (std::size_t m = 0; m < 2; ++m) {
        const std::string modality = m == 0 ? "_track" : "_pose";
        const MatrixD v = chains.visible[m].to_host().cast<double>();
        const MatrixD z = chains.joint.to_host().cast<double>();
        const MatrixD h =
            sigmoid((v * scene.get("W", m) + z * scene.get("U", m).transpose()).rowwise() +
                    RowVectorD(scene.get("b", m).row(0)));
        const MatrixD data_v = scene.data[m].cast<double>();
        const MatrixD data_h = data.hidden[m].to_host().cast<double>();
        const MatrixD data_z = data.joint.to_host().cast<double>();
        const Parameters gradients = training.gradients();
        CHECK(off(gradients, "W" + modality,
                  (v.transpose() * h - data_v.transpose() * data_h) / 6) < 1e-5);
        CHECK(off(gradients, "U" + modality,
                  (h.transpose() * z - data_h.transpose() * data_z) / 6) < 1e-5);
        CHECK(off(gradients, "a" + modality, (v - data_v).colwise().mean()) < 1e-5);
        CHECK(off(gradients, "b" + modality, (h - data_h).colwise().mean()) < 1e-5);
        if (m == 0) CHECK(off(gradients, "c", (z - data_z).colwise().mean()) < 1e-5);
      }
    }
  });
}

TEST_CASE("multimodal DBM: each stage moves its own parameters alone, by rate and decay") {
  on_every_device([](Device& device) {
    const std::vector<std::string> track = {"W_track", "a_track", "b_track"},
                                   top = {"U_track", "U_pose", "b_track", "b_pose", "c"};
    for (const bool joint : {false, true}) {
      Scene scene(device), kept(device);
      scene.settings.momentum = 0;
      scene.settings.weight_decay = 0.3;
      DbmTraining probe(kept.machine, scene.settings, scene.data, OptimizerKind::none);
      DbmTraining training(scene.machine, scene.settings, scene.data);
      for (DbmTraining* one : {&probe, &training})
        if (joint)
          one->learn_joint_layer(0, 0.1F, {4, 7, 9, 0});
        else
          one->learn_pathway(0, 0, 0.1F, {4, 7, 9, 0});
      const std::vector<std::string>& own = joint ? top : track;
      for (const auto& entry : scene.machine.parameters().entries()) {
        CAPTURE(entry.name);
        const MatrixD before = kept.get(entry.name), after = scene.get(entry.name);
        if (std::find(own.begin(), own.end(), entry.name) == own.end()) {
          CHECK(after == before);
          continue;
        }
        const MatrixD gradient = probe.gradients().to_host(entry.name).cast<double>();
        const double decay = entry.is_weight ? 0.3 : 0.0;
        CHECK((after - (before - 0.1 * (gradient + decay * before))).cwiseAbs().maxCoeff() < 1e-5);
      }
    }
  });
}

TEST_CASE("multimodal DBM: a run is its stages one after another, chains start at the data") {
  on_every_device([](Device& device) {
    Scene whole(device), pieces(device);
    for (Scene* scene : {&whole, &pieces}) {
      scene->settings.batch = 3;
      scene->settings.pretraining_epochs = 1;
      scene->settings.epochs = 2;
      scene->settings.pretraining_rate = 0.01;
      scene->settings.rate = 0.1;
    }
    DbmTraining(whole.machine, whole.settings, whole.data).run();
    DbmTraining training(pieces.machine, pieces.settings, pieces.data);
    RandomKey key{1, 0, 0x4d70, 0};
    const auto shuffle = [&] { training.schedule().shuffle({1, key.step, 0x4d70, 0x7000}); };
    for (std::size_t m = 0; m < 2; ++m) {
      shuffle();
      for (std::size_t i = 0; i < 2; ++i, ++key.step) training.learn_pathway(m, 3 * i, 0.01F, key);
    }
    shuffle();
    for (std::size_t i = 0; i < 2; ++i, ++key.step)
      training.learn_joint_layer(3 * i, 10 * 0.01F, key);
    training.start_chains();
    CHECK(training.chains().visible[0].to_host().row(2).cwiseAbs().maxCoeff() > 0);
    CHECK(training.chains().joint.to_host().minCoeff() > 0);
    for (int step = 0; step < 4; ++step, ++key.step) {
      if (step % 2 == 0) shuffle();
      training.learn_all(step % 2 == 0 ? 0 : 3,
                         0.1F * (1.0F - 0.98F * static_cast<float>(step) / 4.0F), key);
    }
    CHECK(whole.machine.parameters().all().to_host() ==
          pieces.machine.parameters().all().to_host());
  });
}

TEST_CASE("multimodal_dbm infers the pose of another clip, far better than the mean") {
  std::vector<MatrixF> tracks, poses, other_tracks, other_poses;
  for (const float phase : {0.0F, 2.0F}) add_clip(tracks, poses, 100, phase);
  add_clip(other_tracks, other_poses, 60, 4.4F);
  MultimodalDbmSettings settings;
  settings.track_hidden = 24;
  settings.pose_hidden = 16;
  settings.joint = 16;
  settings.pretraining_epochs = 5;
  settings.pretraining_rate = 0.01;
  settings.epochs = 30;
  settings.rate = 0.05;
  settings.momentum = 0.5;
  settings.gibbs_sweeps = 2;
  settings.mean_field_steps = 5;
  settings.weight_decay = 2e-4;
  ConstantPose constant;
  constant.fit(tracks, poses);
  on_every_device([&](Device& device) {
    MultimodalDbm baseline(device, settings), same(device, settings);
    baseline.fit(tracks, poses);
    CHECK(error_of(baseline.predict(other_tracks[0]), other_poses[0]) <
          0.4 * error_of(constant.predict(other_tracks[0]), other_poses[0]));
    settings.epochs = 1;
    settings.rate = 100;
    MultimodalDbm wild(device, settings);
    CHECK_THROWS_AS(wild.fit(tracks, poses), Error);
  });
}

}  // namespace multimodal_dbm_test
