// Trainings that are killed again and again and go on from their checkpoints: the same bits and the
// same reports in the end as of an undisturbed one, whatever the rule.
#include "learning/checkpoints.hpp"

#include <doctest/doctest.h>

#include "base/capture_bound.hpp"
#include "base/interruption.hpp"
#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "learning/greedy_scene.hpp"
#include "learning/resumable_training.hpp"
#include "learning/squared_loss.hpp"
#include "mcdbn/base/errors.hpp"

namespace checkpoints_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

std::vector<MatrixF> bits_of(const Mcdbn& network) {
  std::vector<MatrixF> bits;
  for (const Cdbn& cdbn : network.cdbns)
    for (const Crbm& layer : cdbn.layers) {
      const CrbmParameters p = layer.to_host();
      for (const MatrixF& matrix : {p.W, p.A, p.B, p.a, p.b, p.visible_mean, p.visible_deviation,
                                    layer.W_transposed.to_host()})
        bits.push_back(matrix);
    }
  const MrbmParameters p = network.mrbm.to_host();
  bits.insert(bits.end(), p.W.begin(), p.W.end());
  bits.insert(bits.end(), p.a.begin(), p.a.end());
  bits.push_back(p.b);
  return bits;
}

/// What an epoch reports, but for the speed.
struct Line {
  std::string stage;
  std::size_t epoch;
  double loss, held_out_loss, weight_norm;
  bool operator==(const Line&) const = default;
};
Line line_of(const EpochReport& report) {
  return {report.stage, report.epoch, report.loss, report.held_out_loss.value_or(-1),
          report.health ? report.health->weight_norm : -1};
}

struct Killed {};

/// A training of a network, given who watches it.
using Training = std::function<Mcdbn(const EpochObserver&, Checkpoints*)>;

/// One that keeps what it reported as a log in a file is kept: what comes after the checkpoint that
/// it goes on from is dropped.
class KilledTraining {
 public:
  KilledTraining(std::filesystem::path folder, Training training)
      : folder_(std::move(folder)), training_(std::move(training)) {}

  /// Goes on from the last checkpoint if there is one. @param after so many checkpoints it is
  /// killed while it writes the next one; 0: never  @throws Killed
  Mcdbn run(std::size_t after) {
    std::size_t written = 0, count = 0;
    Checkpoints::Options options;
    options.folder = folder_;
    options.extra_state = [&](TrainingState& state) {
      if (!state.restores()) count = lines.size();
      state.number("lines", count);
      if (!state.restores() && after > 0 && ++written > after) throw Killed{};
    };
    options.warn = [this](const std::string& text) { warnings.push_back(text); };
    Checkpoints checkpoints(options);
    lines.resize(count);
    return training_([this](const EpochReport& report) { lines.push_back(line_of(report)); },
                     &checkpoints);
  }
  /// Is killed after every `after` checkpoints until it ends by itself.
  std::vector<MatrixF> run_to_end(std::size_t after) {
    while (true) {
      try {
        return bits_of(run(after));
      } catch (const Killed&) {
        REQUIRE(++kills < 1000);
      }
    }
  }

  std::vector<Line> lines = {};
  std::vector<std::string> warnings = {};
  std::size_t kills = 0;

 private:
  std::filesystem::path folder_;
  Training training_;
};

/// @param least kills
void check_killed(const Training& training, std::size_t least) {
  std::vector<Line> lines;
  const auto wanted = bits_of(
      training([&](const EpochReport& report) { lines.push_back(line_of(report)); }, nullptr));
  const ScratchFolder folder;
  KilledTraining killed(folder / "", training);
  CHECK(killed.run_to_end(7) == wanted);
  CHECK(killed.lines == lines);
  CHECK(killed.warnings.empty());
  CHECK(killed.kills >= least);
}

LearningSettings small_settings() {
  return settings_of(scene_of_different_sizes().plan);
}

Training greedy(Device& device, const MatrixSource& source, const LearningSettings& settings) {
  return [&device, &source, settings](const EpochObserver& observer, Checkpoints* checkpoints) {
    return train_greedy(device, checkpoints, source, settings, observer);
  };
}

MatrixSource small_source() {
  const GreedyScene scene = scene_of_different_sizes();
  return MatrixSource({{"track", scene.tracks}, {"pose", scene.poses}});
}

/// Clips that are others after every few mini-batches, whatever was drawn before.
class ChangingSource : public SequenceSource {
 public:
  SynchronizedClips sequences() const override {
    return {{{"track", tracks_}, {"pose", poses_}}, {}};
  }
  bool renew(std::size_t step) const override {
    constexpr std::size_t kLasts = 7;
    if (step / kLasts == round_) return false;
    round_ = step / kLasts;
    tracks_ = tiny_clips(3, 100 + static_cast<unsigned>(10 * round_));
    poses_ = tiny_clips(5, 900 + static_cast<unsigned>(10 * round_));
    return true;
  }

 private:
  mutable std::size_t round_ = 0;
  mutable std::vector<MatrixF> tracks_ = tiny_clips(3, 100), poses_ = tiny_clips(5, 900);
};

/// Forgets a request however the test ends.
struct NoRequestLeft {
  ~NoRequestLeft() { clear_interruption(); }
};

}  // namespace

TEST_CASE("a greedy training that is killed ends with the same bits, whatever its rules") {
  const MatrixSource source = small_source();
  std::vector<std::pair<std::string, LearningSettings>> all;
  const auto add = [&](const std::string& name) -> LearningSettings& {
    return all.emplace_back(name, small_settings()).second;
  };
  add("momentum, multi-prediction by Adam");
  {
    LearningSettings& settings = add("noise, target, joint likelihood by momentum");
    for (CdSettings* cd : {&settings.gaussian, &settings.binary}) {
      cd->history_noise = 0.3;
      cd->sparsity_strength = 0.1;
    }
    settings.mrbm.joint_likelihood = true;
    settings.mrbm.adam = false;
  }
  {
    LearningSettings& settings = add("persistent chains everywhere, Adam");
    for (CdSettings* cd : {&settings.gaussian, &settings.binary}) {
      cd->persistent = cd->adam = true;
      cd->rate = cd->rate_A = cd->rate_B = 1e-2;
    }
    settings.mrbm.joint_likelihood = settings.mrbm.persistent = true;
  }
  {
    LearningSettings& settings = add("fast weights, CD-PercLoss");
    for (CdSettings* cd : {&settings.gaussian, &settings.binary}) {
      cd->persistent = true;
      cd->rate = cd->rate_A = cd->rate_B = 1e-3;
      cd->fast_rate = 1e-3;
    }
    settings.mrbm.perceptron_loss = true;
  }
  on_every_device([&](Device& device) {
    for (const auto& [name, settings] : all) {
      CAPTURE_BOUND(name);
      check_killed(greedy(device, source, settings), 10);
    }
  });
}

TEST_CASE("fine-tuning that is killed ends with the same bits, what was kept of it too") {
  const MatrixSource source = small_source();
  const MatrixSource held_out_clips({{"track", tiny_clips(3, 700)}, {"pose", tiny_clips(5, 800)}});
  LearningSettings settings = small_settings();
  settings.fine_tuning.steps = 160;
  settings.fine_tuning.windows = 3;
  settings.fine_tuning.rate = 3e-2;
  settings.fine_tuning.reverse = 0.5;
  const SequenceLossMaker squares = [](Device& device, const SequenceWindows& windows) {
    return std::make_unique<SquaredLoss>(device, windows, 1.0);
  };
  on_every_device([&](Device& device) {
    const Mcdbn start = train_greedy(device, source, settings);
    for (const SequenceSource* held_out_source :
         {static_cast<const SequenceSource*>(nullptr),
          static_cast<const SequenceSource*>(&held_out_clips)}) {
      CAPTURE(held_out_source != nullptr);
      check_killed(
          [&](const EpochObserver& observer, Checkpoints* checkpoints) {
            return fine_tune(device, checkpoints, start, source, held_out_source, settings, squares,
                             observer)
                .network;
          },
          10);
    }
    check_killed(
        [&](const EpochObserver& observer, Checkpoints* checkpoints) {
          return fine_tune(device, checkpoints, start, ChangingSource(), &held_out_clips, settings,
                           squares, observer)
              .network;
        },
        10);
    const auto learnt = [&](const SequenceSource& from) {
      return bits_of(fine_tune(device, start, from, nullptr, settings, squares).network);
    };
    const MatrixSource first({{"track", tiny_clips(3, 100)}, {"pose", tiny_clips(5, 900)}});
    CHECK(learnt(ChangingSource()) != learnt(first));
  });
}

namespace {

/// Sums nothing up, so that a checkpoint has nothing to keep of it.
class LossWithoutSums : public SequenceLoss {
 public:
  LossWithoutSums(Device& device, const SequenceWindows& windows)
      : squares_(device, windows, 1.0) {}
  void differentiate(const Matrix& prediction, const Matrix& target, Matrix& error) override {
    squares_.differentiate(prediction, target, error);
  }
  double read_and_reset() override { return 1.0; }

 private:
  SquaredLoss squares_;
};

}  // namespace

TEST_CASE("fine-tuning by a loss without sums, which names no state, ends with the same bits") {
  const MatrixSource source = small_source();
  LearningSettings settings = small_settings();
  settings.fine_tuning.steps = 30;
  settings.fine_tuning.windows = 3;
  const SequenceLossMaker make_loss = [](Device& device, const SequenceWindows& windows) {
    return std::make_unique<LossWithoutSums>(device, windows);
  };
  on_every_device([&](Device& device) {
    const Mcdbn start = train_greedy(device, source, settings);
    check_killed(
        [&](const EpochObserver& observer, Checkpoints* checkpoints) {
          return fine_tune(device, checkpoints, start, source, nullptr, settings, make_loss,
                           observer)
              .network;
        },
        2);
  });
}

TEST_CASE("of a damaged checkpoint the one before it is taken") {
  const MatrixSource source = small_source();
  on_every_device([&](Device& device) {
    const Training training = greedy(device, source, small_settings());
    const auto wanted = bits_of(training({}, nullptr));
    const ScratchFolder folder;
    KilledTraining killed(folder / "", training);
    CHECK_THROWS_AS(killed.run(40), Killed);
    REQUIRE(std::filesystem::exists(folder / "checkpoint.previous.safetensors"));
    const std::string last = read_text_file(folder / "checkpoint.safetensors");
    folder.write("checkpoint.safetensors", last.substr(0, last.size() / 2));
    CHECK(bits_of(killed.run(0)) == wanted);
    REQUIRE(killed.warnings.size() == 1);
    CHECK(killed.warnings[0].find("checkpoint.safetensors") != std::string::npos);

    folder.write("checkpoint.safetensors", "x");
    folder.write("checkpoint.previous.safetensors", last.substr(0, 7));
    CHECK_THROWS_AS(killed.run(0), InputError);
  });
}

TEST_CASE("a checkpoint of another training is refused") {
  const MatrixSource source = small_source();
  LearningSettings wider = small_settings();
  wider.hidden = 40;  // beyond the padding
  on_every_device([&](Device& device) {
    const ScratchFolder folder;
    KilledTraining killed(folder / "", greedy(device, source, small_settings()));
    CHECK_THROWS_AS(killed.run(5), Killed);
    CHECK_THROWS_WITH_AS(KilledTraining(folder / "", greedy(device, source, wider)).run(0),
                         doctest::Contains((folder / "checkpoint.safetensors: ").c_str()),
                         InputError);
    const MatrixSource named(
        {{"2D", scene_of_different_sizes().tracks}, {"3D", scene_of_different_sizes().poses}});
    CHECK_THROWS_WITH_AS(
        KilledTraining(folder / "", greedy(device, named, small_settings())).run(0),
        doctest::Contains((folder / "checkpoint.safetensors: ").c_str()), InputError);
  });
}

TEST_CASE("asked to stop, a training writes a checkpoint between two mini-batches") {
  const MatrixSource source = small_source();
  on_every_device([&](Device& device) {
    const NoRequestLeft after;
    const Training training = greedy(device, source, small_settings());
    const auto wanted = bits_of(training({}, nullptr));
    const ScratchFolder folder;
    Checkpoints::Options options;
    options.folder = folder / "";
    options.every = std::chrono::hours(1);
    Checkpoints first(options);
    const auto stop_in_second_epoch = [](const EpochReport& report) {
      if (report.stage == "pose.1" && report.epoch == 2) request_interruption();
    };
    CHECK_THROWS_AS(training(stop_in_second_epoch, &first), Interrupted);
    clear_interruption();
    Checkpoints second(options);
    std::vector<Line> lines;
    CHECK(bits_of(training([&](const EpochReport& report) { lines.push_back(line_of(report)); },
                           &second)) == wanted);
    REQUIRE(!lines.empty());
    CHECK(lines.front().stage == "pose.1");
    CHECK(lines.front().epoch == 3);
  });
}

TEST_CASE("a request to stop waits for the end of a mini-batch only for a checkpoint") {
  const auto nothing = [](TrainingState&) {};
  on_every_device([&](Device& device) {
    const NoRequestLeft after;
    const ScratchFolder folder;
    Checkpoints::Options options;
    options.folder = folder / "";
    options.every = std::chrono::hours(1);
    Checkpoints checkpoints(options);
    {
      StageRun kept(device, &checkpoints, "stage", nothing, nothing);
      kept.after_step(1);
      request_interruption();
      CHECK_NOTHROW(check_interruption());
      CHECK_THROWS_AS(kept.after_step(2), Interrupted);
      CHECK(Checkpoints::exist_in(folder / ""));
      clear_interruption();
    }
    StageRun unkept(device, nullptr, "stage", nothing, nothing);
    CHECK_NOTHROW(unkept.after_step(1));
    request_interruption();
    CHECK_THROWS_AS(check_interruption(), Interrupted);
    CHECK_THROWS_AS(unkept.after_step(2), Interrupted);
    clear_interruption();
  });
}

TEST_CASE("asked to stop, first weights are not drawn to the end") {
  const NoRequestLeft after;
  const CrbmShape shape{3, 4, 1, VisibleKind::gaussian};
  CHECK_NOTHROW(CrbmParameters::random(shape, 0.1, {}));
  request_interruption();
  CHECK_THROWS_AS(CrbmParameters::random(shape, 0.1, {}), Interrupted);
}

TEST_CASE("a checkpoint that cannot be written is a warning, and the training goes on") {
  const MatrixSource source = small_source();
  on_every_device([&](Device& device) {
    const Training training = greedy(device, source, small_settings());
    const auto wanted = bits_of(training({}, nullptr));
    const ScratchFolder folder;
    KilledTraining nowhere(folder / "absent", training);
    CHECK(bits_of(nowhere.run(0)) == wanted);
    REQUIRE(!nowhere.warnings.empty());
    CHECK(nowhere.warnings[0].find("No such file or directory") != std::string::npos);
  });
}

}  // namespace checkpoints_test
