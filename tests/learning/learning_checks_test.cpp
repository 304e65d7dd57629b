// What the library's trainings refuse before anything is learnt.

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "device/every_device.hpp"
#include "learning/squared_loss.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/learning/fine_tuning.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"

namespace learning_checks_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr VisibleKind kGaussian = VisibleKind::gaussian, kBinary = VisibleKind::binary;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinite = std::numeric_limits<float>::infinity();
constexpr std::size_t kLeft = 0, kRight = 1;

/// Values from 0 to 1.
MatrixF shares(std::size_t rows, std::size_t columns, unsigned seed) {
  return (0.5F * (random_matrix(rows, columns, seed).array() + 1.0F)).matrix();
}

/// A binary modality of 3 columns and a Gaussian one of 4, of two clips.
std::vector<ModalityMatrices> usual_data() {
  return {{"left", {shares(20, 3, 1), shares(14, 3, 2)}, kBinary},
          {"right", {random_matrix(20, 4, 3), random_matrix(14, 4, 4)}, kGaussian}};
}

LearningSettings small_settings() {
  LearningSettings settings;
  settings.order = 1;
  settings.hidden = 4;
  settings.mrbm_hidden = 3;
  settings.look_ahead = 0;
  settings.batch = 8;
  settings.least_batches = 1;
  settings.gaussian.epochs = settings.binary.epochs = settings.mrbm.epochs = 1;
  settings.fine_tuning.steps = 2;
  settings.fine_tuning.windows = 2;
  settings.fine_tuning.window_frames = 3;
  settings.fine_tuning.settle_frames = 1;
  return settings;
}

/// Every training, and how often one has reported.
class Trainings {
 public:
  explicit Trainings(Device& device)
      : device_(device), start_(train_greedy(device, MatrixSource(usual_data()), settings)) {}

  void greedy(const std::vector<ModalityMatrices>& data) {
    train_greedy(device_, MatrixSource(data), settings, observer_);
  }
  Mcdbn fine_tuning(const std::vector<ModalityMatrices>& data,
                    const std::vector<ModalityMatrices>& held_out = usual_data()) {
    const MatrixSource source(data), held_out_source(held_out);
    const auto squares = [](Device& device, const SequenceWindows& windows) {
      return std::make_unique<SquaredLoss>(device, windows, 1.0);
    };
    return fine_tune(device_, start_, source, &held_out_source, settings, squares, observer_)
        .network;
  }
  void layer(const ModalityMatrices& data) {
    const CrbmShape shape = shape_of(data);
    train_crbm(device_, sequences_of(data), CrbmParameters::zeros(shape),
               data.kind == kBinary ? settings.binary : settings.gaussian, settings, 0, observer_);
  }
  void stack(const ModalityMatrices& data) {
    train_cdbn(device_, sequences_of(data), {shape_of(data)}, settings, 0, observer_);
  }
  void shared(const std::vector<ModalityMatrices>& data) {
    std::vector<Sequences> codes;
    MrbmShape shape{{}, 3};
    for (const ModalityMatrices& modality : data) {
      codes.push_back(sequences_of(modality));
      shape.modalities.push_back({modality.name, codes.back().values.columns(), modality.kind});
    }
    shared(codes, shape);
  }
  void shared(const std::vector<Sequences>& codes, const MrbmShape& shape) {
    train_mrbm(device_, codes, MrbmParameters::random(shape, 0.1, {1}), settings, 0, observer_);
  }

  LearningSettings settings = small_settings();
  int reports = 0;

 private:
  static CrbmShape shape_of(const ModalityMatrices& data) {
    return {static_cast<std::size_t>(data.clips.front().cols()), 4, 1, data.kind};
  }
  Sequences sequences_of(const ModalityMatrices& data) const {
    return Sequences::from_host(device_, data.clips);
  }

  Device& device_;
  Mcdbn start_;
  EpochObserver observer_ = [this](const EpochReport&) { ++reports; };
};

}  // namespace

TEST_CASE("every training refuses values that its units cannot take before anything is learnt") {
  on_every_device([](Device& device) {
    Trainings train(device);
    for (const std::size_t m : {kLeft, kRight})
      for (const float value : {kNan, kInfinite, -kInfinite, 1.25F, -0.25F}) {
        if (m == kRight && std::isfinite(value)) continue;
        CAPTURE(m);
        CAPTURE(value);
        std::vector<ModalityMatrices> odd = usual_data();
        odd[m].clips[1](6, 2) = value;
        CHECK_THROWS_AS(train.greedy(odd), InputError);
        CHECK_THROWS_AS(train.fine_tuning(odd), InputError);
        CHECK_THROWS_AS(train.fine_tuning(usual_data(), odd), InputError);
        CHECK_THROWS_AS(train.layer(odd[m]), InputError);
        CHECK_THROWS_AS(train.stack(odd[m]), InputError);
        CHECK_THROWS_AS(train.shared(odd), InputError);
      }
    CHECK(train.reports == 0);
    std::vector<ModalityMatrices> odd = usual_data();
    odd[kLeft].clips[1](6, 2) = 1.25F;
    CHECK_THROWS_WITH(train.greedy(odd),
                      "left, clip 2: row 7, column 3 is 1.25; binary units need values from 0 to 1 "
                      "(Gaussian units take any)");
    CHECK_THROWS_WITH(train.layer(odd[kLeft]),
                      "crbm: row 27, column 3 is 1.25; binary units need values from 0 to 1 "
                      "(Gaussian units take any)");
    // None of them refuses what its units can take.
    odd = usual_data();
    odd[kLeft].clips[1](6, 2) = 1.0F;
    odd[kRight].clips[1](6, 2) = -3.0F;
    CHECK_NOTHROW(train.greedy(odd));
    CHECK_NOTHROW(train.fine_tuning(odd, odd));
    CHECK_NOTHROW(train.layer(odd[kLeft]));
    CHECK_NOTHROW(train.stack(odd[kRight]));
    CHECK_NOTHROW(train.shared(odd));
  });
}

TEST_CASE("rows of a code that have none are not looked at") {
  on_every_device([](Device& device) {
    MatrixF values = shares(20, 3, 5);
    values.topRows(2).setConstant(kNan);
    Sequences code = Sequences::from_host(device, {values});
    const LearningSettings settings = small_settings();
    const auto train = [&] {
      return train_crbm(device, code, CrbmParameters::zeros({3, 4, 1, kBinary}), settings.binary,
                        settings, 0);
    };
    CHECK_THROWS_AS(train(), InputError);
    code.valid_from = 2;
    CHECK(train().W.to_host().allFinite());
  });
}

TEST_CASE("an MRBM refuses sequences that do not belong together") {
  on_every_device([](Device& device) {
    Trainings train(device);
    std::vector<ModalityMatrices> data = usual_data();
    data[kRight].clips.pop_back();  // fewer rows
    CHECK_THROWS_AS(train.shared(data), ShapeError);
    data = usual_data();
    std::swap(data[kRight].clips[0], data[kRight].clips[1]);  // as many rows, other clips
    CHECK_THROWS_WITH_AS(train.shared(data), doctest::Contains("differ in their clips' rows"),
                         ShapeError);

    std::vector<Sequences> codes{Sequences::from_host(device, usual_data()[kLeft].clips),
                                 Sequences::from_host(device, usual_data()[kRight].clips)};
    const MrbmShape fits{{{"left", 3}, {"right", 4, kGaussian}}, 3};
    CHECK_THROWS_AS(train.shared(codes, {{{"left", 3}, {"right", 5, kGaussian}}, 3}), ShapeError);
    CHECK_THROWS_AS(train.shared(codes, {{{"left", 3}, {"right", 4, kGaussian}, {"third", 4}}, 3}),
                    ShapeError);
    CHECK(train.reports == 0);
    CHECK_NOTHROW(train.shared(codes, fits));
    codes.push_back(codes.back());
    CHECK_THROWS_AS(train.shared(codes, fits), ShapeError);
    CHECK_THROWS_AS(initial_mrbm_weights(fits, codes, train.settings), ShapeError);
  });
}

TEST_CASE("fine-tuning refuses sequences that do not fit the network, held out or not") {
  on_every_device([](Device& device) {
    Trainings train(device);
    const auto refused = [&](const std::vector<ModalityMatrices>& data) {
      CHECK_THROWS_AS(train.fine_tuning(data), ShapeError);
      CHECK_THROWS_AS(train.fine_tuning(usual_data(), data), ShapeError);
    };
    std::vector<ModalityMatrices> data = usual_data();
    data[kRight].clips[1] = random_matrix(13, 4, 6);  // a frame less than the other modality
    refused(data);
    data[kRight].clips[1] = random_matrix(14, 5, 6);  // a column more than the other clip
    refused(data);
    data[kRight].clips[0] = random_matrix(20, 5, 6);  // than the network
    refused(data);
    data.pop_back();
    refused(data);
    CHECK(train.reports == 0);
  });
}

TEST_CASE("fine-tuning at another look-ahead than the network's is refused") {
  on_every_device([](Device& device) {
    Trainings train(device);
    train.settings.look_ahead = 5;
    CHECK_THROWS_WITH_AS(train.fine_tuning(usual_data()),
                         "`look-ahead` is 5, but 0 in the network to start from", ConfigError);
    CHECK(train.reports == 0);
    train.settings.look_ahead = 0;
    CHECK(train.fine_tuning(usual_data()).look_ahead == 0);
  });
}

TEST_CASE("pieces of a corpus need to be of groups that it has") {
  const MatrixSource source(usual_data(), {0, 1});
  SynchronizedClips clips = source.sequences();
  std::vector<double> frames{30.0};
  clips.group_frames = frames;
  CHECK_THROWS_AS(clips.check(), ShapeError);
  frames.push_back(12.0);
  clips.group_frames = frames;
  CHECK_NOTHROW(clips.check());
}

}  // namespace learning_checks_test
