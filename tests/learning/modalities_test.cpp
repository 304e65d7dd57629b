// Learning from more than two modalities, and from Gaussian ones.

#include <doctest/doctest.h>

#include <numeric>

#include "base/scratch_folder.hpp"
#include "learning/contrastive_divergence.hpp"
#include "learning/multi_prediction.hpp"
#include "learning/small_network.hpp"
#include "learning/squared_loss.hpp"
#include "learning/unrolled_pass.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/learning/fine_tuning.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"
#include "mcdbn/machines/energy.hpp"
#include "mcdbn/machines/generation.hpp"
#include "mcdbn/machines/machine_file.hpp"
#include "mcdbn/machines/regeneration.hpp"
#include "reference/finite_difference.hpp"

namespace modalities_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr VisibleKind kBinary = VisibleKind::binary, kGaussian = VisibleKind::gaussian;

struct Case {
  std::vector<std::pair<std::size_t, VisibleKind>> modalities;
  std::size_t hidden, batch, steps;
};

struct Problem {
  explicit Problem(const Case& test) : test(test) {
    MrbmShape shape{{}, test.hidden};
    for (const auto& [visible, kind] : test.modalities)
      shape.modalities.push_back({std::to_string(shape.modalities.size()), visible, kind});
    start = MrbmParameters::zeros(shape);
    unsigned seed = 0;
    for (std::size_t m = 0; m < shape.modalities.size(); ++m) {
      const auto& [visible, kind] = test.modalities[m];
      start.W[m] = random_matrix(visible, test.hidden, ++seed, 0.5F);
      start.a[m] = random_matrix(1, visible, ++seed, 0.5F);
      const MatrixF drawn = random_matrix(2 * test.batch, visible, ++seed);
      frames.push_back(kind == kGaussian ? drawn
                                         : MatrixF((0.5F * (drawn.array() + 1.0F)).matrix()));
      batch.push_back(frames[m].bottomRows(static_cast<Eigen::Index>(test.batch)).cast<double>());
    }
    start.b = random_matrix(1, test.hidden, ++seed, 0.5F);
  }

  Case test;
  MrbmParameters start;
  std::vector<MatrixF> frames;
  std::vector<MatrixD> batch;
};

void check_gradients(Device& device, const Problem& problem, const std::optional<RowTile>& tile) {
  const Case& test = problem.test;
  std::vector<Matrix> frames;
  for (const MatrixF& matrix : problem.frames) frames.push_back(Matrix::from_host(device, matrix));
  std::vector<std::int32_t> last(test.batch);
  std::iota(last.begin(), last.end(), static_cast<std::int32_t>(test.batch));
  const IndexBuffer index(device, last);
  std::vector<Rows> rows;
  for (const Matrix& matrix : frames) rows.push_back(Rows::indexed(matrix, index, 0, test.batch));
  const auto want =
      reference::bounded_multi_prediction(reference::BoundedMrbm::exact(in_double(problem.start)),
                                          problem.batch, static_cast<int>(test.steps));
  Mrbm mrbm(device, problem.start);
  MultiPrediction rule(mrbm, test.batch, {.mean_field_steps = test.steps}, tile,
                       OptimizerKind::none);
  LossAccumulator losses(device, rule.loss_count(), test.batch);
  for (int i = 0; i < 2; ++i) {  // the second shows that nothing is left behind
    losses.read_and_reset();
    rule.step(rows, UpdateRule::adam(), losses);
  }
  check_within(rule.gradients(), want.gradient);
  const auto got = losses.read_and_reset();
  REQUIRE(got.size() == want.losses.size());
  for (std::size_t m = 0; m < got.size(); ++m) check_within("loss", got[m], want.losses[m]);
}

/// Three Gaussian modalities of a few clips, each a mixture of the same waves.
std::vector<ModalityMatrices> three_modalities() {
  std::vector<ModalityMatrices> modalities{{"one", {}}, {"two", {}}, {"three", {}}};
  for (const Eigen::Index frames : {31, 47}) {
    MatrixF waves(frames, 4);
    for (Eigen::Index t = 0; t < frames; ++t)
      for (Eigen::Index c = 0; c < 4; ++c)
        waves(t, c) = std::sin(0.15F * static_cast<float>((t + frames) * (c + 1)));
    for (std::size_t m = 0; m < 3; ++m)
      modalities[m].clips.emplace_back(
          waves * random_matrix(4, 3 + m, 90 + static_cast<unsigned>(m), 1.0F));
  }
  return modalities;
}

LearningSettings small_settings() {
  LearningSettings settings;
  settings.order = 2;
  settings.hidden = 6;
  settings.mrbm_hidden = 5;
  settings.look_ahead = 1;
  settings.batch = 10;
  settings.least_batches = 4;
  settings.fine_tuning.windows = 4;
  settings.fine_tuning.window_frames = 4;
  settings.fine_tuning.settle_frames = 1;
  return settings;
}

}  // namespace

TEST_CASE("small: multi-prediction of three modalities and of Gaussian ones is the reference's") {
  for (const Case& test : {Case{{{4, kBinary}, {3, kBinary}, {5, kBinary}}, 6, 5, 3},
                           Case{{{3, kGaussian}, {7, kBinary}}, 4, 3, 2},
                           Case{{{2, kBinary}, {5, kGaussian}, {1, kGaussian}}, 3, 4, 3}}) {
    const Problem problem(test);
    on_every_device([&](Device& device) {
      std::size_t largest = 0;
      for (const auto& [visible, kind] : test.modalities) largest = std::max(largest, visible);
      const auto tile = choose_chain_tile(device, {largest, test.hidden}, test.batch);
      REQUIRE(tile);
      check_gradients(device, problem, tile);
      check_gradients(device, problem, std::nullopt);
    });
  }
}

TEST_CASE("multi-prediction of four modalities at odd sizes, fused and composed") {
  const Problem problem({{{33, kBinary}, {17, kGaussian}, {5, kBinary}, {19, kBinary}}, 21, 23, 4});
  on_every_device([&](Device& device) {
    check_gradients(device, problem, choose_chain_tile(device, {33, 21}, 23));
    check_gradients(device, problem, std::nullopt);
  });
}

TEST_CASE("reference: multi-prediction of Gaussian modalities is the gradient of its loss") {
  const Problem problem({{{3, kGaussian}, {4, kBinary}, {2, kGaussian}}, 3, 4, 3});
  const reference::Mrbm model = in_double(problem.start);
  constexpr int kSteps = 3;
  const auto numeric = reference::finite_difference(
      [&](const Eigen::VectorXd& x) {
        return reference::multi_prediction(model.with_parameters(x), problem.batch, kSteps).loss;
      },
      model.flattened());
  const auto exact = reference::multi_prediction(model, problem.batch, kSteps).gradient.flattened();
  CHECK((numeric - exact).cwiseAbs().maxCoeff() < 1e-8);
}

TEST_CASE("the unrolled pass of three modalities, one binary: each is predicted from the others") {
  constexpr SequenceWindows kWindows{.count = 2, .frames = 7, .first = 3, .judged_from = 4};
  constexpr std::size_t kMeanFieldSteps = 2;
  const std::array<std::size_t, 3> visible{3, 4, 2}, hidden{4, 3, 5}, order{2, 1, 3};
  const std::array<VisibleKind, 3> kind{kGaussian, kBinary, kGaussian};
  MrbmShape shape{{{"one", hidden[0]}, {"two", hidden[1]}, {"three", hidden[2]}}, 4};
  MrbmParameters mrbm = MrbmParameters::zeros(shape);
  std::vector<CrbmParameters> layers;
  std::vector<MatrixF> frames;
  reference::UnrolledModel model;
  for (std::size_t m = 0; m < 3; ++m) {
    const auto seed = static_cast<unsigned>(100 * m);
    layers.push_back(random_layer({visible[m], hidden[m], order[m], kind[m]}, seed));
    mrbm.W[m] = random_matrix(hidden[m], 4, seed + 20, 0.8F);
    mrbm.a[m] = random_matrix(1, hidden[m], seed + 21, 0.5F);
    frames.push_back(random_matrix(kWindows.rows(), visible[m], seed + 22));
    model.stacks.push_back({in_double(layers[m])});
    model.start.push_back({layers[m].visible_mean.cast<double>()});
  }
  mrbm.b = random_matrix(1, 4, 7, 0.5F);
  model.mrbm = in_double(mrbm);
  for (std::size_t absent = 0; absent < 3; ++absent) {
    CAPTURE(absent);
    const auto window = [&](const MatrixF& all, std::size_t i) {
      return MatrixD(all.middleRows(static_cast<Eigen::Index>(i * kWindows.frames),
                                    static_cast<Eigen::Index>(kWindows.frames))
                         .cast<double>());
    };
    const auto predicted = [&](const reference::UnrolledModel& with, std::size_t i) {
      std::vector<MatrixD> values;
      for (const MatrixF& all : frames) values.push_back(window(all, i));
      return reference::joint_prediction(with, absent, values, 3, kMeanFieldSteps);
    };
    // Σ of the squares of the frames from `judged_from` on.
    const auto loss = [&](const Eigen::VectorXd& flat) {
      double sum = 0;
      for (std::size_t i = 0; i < kWindows.count; ++i)
        sum += 0.5 * predicted(model.with_parameters(flat), i)
                         .bottomRows(kWindows.frames - kWindows.judged_from)
                         .squaredNorm();
      return sum;
    };
    reference::UnrolledModel want =
        model.with_parameters(reference::finite_difference(loss, model.flattened()));
    on_every_device([&](Device& device) {
      Mcdbn start{std::vector<Cdbn>(3), Mrbm(device, mrbm), 0, kMeanFieldSteps};
      for (std::size_t m = 0; m < 3; ++m) start.cdbns[m].layers.emplace_back(device, layers[m]);
      UnrolledNetwork network(device, start, kMeanFieldSteps);
      UnrolledPass pass(network, absent, kWindows);
      std::vector<std::int32_t> all(kWindows.rows());
      std::iota(all.begin(), all.end(), 0);
      const IndexBuffer index(device, all);
      std::vector<Matrix> on_device;
      for (const MatrixF& matrix : frames) on_device.push_back(Matrix::from_host(device, matrix));
      std::vector<Rows> rows;
      for (const Matrix& matrix : on_device)
        rows.push_back(Rows::indexed(matrix, index, 0, kWindows.rows()));
      network.clear_gradients();
      pass.forward(rows, 1.0F, {});
      const MatrixF got = pass.prediction().to_host();
      MatrixF error = MatrixF::Zero(got.rows(), got.cols());
      for (std::size_t i = 0; i < kWindows.count; ++i) {
        const auto first = static_cast<Eigen::Index>(i * kWindows.frames);
        const auto judged = static_cast<Eigen::Index>(kWindows.frames - kWindows.judged_from);
        const MatrixD difference =
            got.middleRows(first + 3, 4).cast<double>() - predicted(model, i).bottomRows(4);
        CHECK(difference.cwiseAbs().maxCoeff() < 1e-4);
        error.middleRows(first + 4, judged) = got.middleRows(first + 4, judged);
      }
      MatrixF with_room =
          MatrixF::Zero(static_cast<Eigen::Index>(pass.prediction_error().rows()), error.cols());
      with_room.topRows(error.rows()) = error;
      pass.prediction_error().upload(with_room);
      pass.backward();
      const auto check = [](const Matrix& gradient, const MatrixD& wanted) {
        CHECK((gradient.to_host().cast<double>() - wanted).cwiseAbs().maxCoeff() <
              2e-4 * (1.0 + wanted.cwiseAbs().maxCoeff()));
      };
      // Weights between units about zero have the gradients of those between units about one half
      // less what biases take of it.
      for (std::size_t m = 0; m < 3; ++m) {
        const MatrixD own =
            want.stacks[m][0].weights - 0.5 * want.stacks[m][0].visible_bias.transpose() *
                                            RowVectorD::Ones(want.stacks[m][0].weights.cols());
        check(network.layers(m)[0].gradient.W, own);
        check(network.layers(m)[0].gradient.a, want.stacks[m][0].visible_bias);
        check(network.layers(m)[0].gradient.b, want.stacks[m][0].hidden_bias);
        const MatrixD shared =
            want.mrbm.weights[m] -
            0.5 * (MatrixD::Ones(want.mrbm.weights[m].rows(), 1) * want.mrbm.hidden_bias +
                   want.mrbm.visible_bias[m].transpose() *
                       MatrixD::Ones(1, want.mrbm.weights[m].cols()));
        check(network.mrbm_gradient().W[m], shared);
        check(network.mrbm_gradient().a[m], want.mrbm.visible_bias[m]);
      }
      check(network.mrbm_gradient().b, want.mrbm.hidden_bias);
    });
  }
}

TEST_CASE("three modalities are trained greedily, fine-tuned and regenerated from the others") {
  const MatrixSource source(three_modalities());
  LearningSettings settings = small_settings();
  settings.hidden = settings.mrbm_hidden = 16;
  settings.gaussian.epochs = 20;
  settings.mrbm.epochs = 20;
  settings.mrbm.rate = 1e-2;
  settings.fine_tuning.steps = 300;
  settings.fine_tuning.rate = 2e-2;
  settings.fine_tuning.reverse = 1.0;
  const SequenceLossMaker squares = [](Device& device, const SequenceWindows& windows) {
    return std::make_unique<SquaredLoss>(device, windows, 1.0);
  };
  const auto clips = source.sequences();
  on_every_device([&](Device& device) {
    std::vector<std::string> stages;
    const Mcdbn greedy = train_greedy(device, source, settings, [&](const EpochReport& report) {
      if (stages.empty() || stages.back() != report.stage) stages.push_back(report.stage);
    });
    CHECK(stages == std::vector<std::string>{"three.0", "two.0", "one.0", "mrbm"});
    const Mcdbn tuned = fine_tune(device, greedy, source, nullptr, settings, squares).network;
    for (std::size_t wanted = 0; wanted < 3; ++wanted) {
      CAPTURE(wanted);
      std::vector<std::vector<MatrixF>> present;
      for (const ModalityClips& modality : clips.modalities)
        present.emplace_back(modality.clips.begin(), modality.clips.end());
      present[wanted].clear();
      const auto answers = regenerate(tuned, present, wanted);
      REQUIRE(answers.size() == 2);
      double error = 0, variance = 0;
      for (std::size_t i = 0; i < 2; ++i) {
        const MatrixF& truth = clips.modalities[wanted].clips[i];
        REQUIRE(answers[i].rows() == truth.rows());
        REQUIRE(answers[i].cols() == truth.cols());
        error += (answers[i] - truth).squaredNorm();
        variance += truth.squaredNorm();
      }
      CHECK(error < 0.7 * variance);  // a mean of zeros has all of it
    }
    CHECK_THROWS_AS(regenerate(tuned, {{}, {}, {}}, 3), ShapeError);

    // A free sample of all three: one leads, each other follows from those that are there.
    GenerationOptions free_run;
    free_run.frames = 12;
    free_run.samples = 2;
    free_run.gibbs_steps = 3;
    const std::vector<MatrixF> seeds(clips.modalities[1].clips.begin(),
                                     clips.modalities[1].clips.end());
    const auto free_sample = generate(tuned, 1, seeds, free_run);
    REQUIRE(free_sample.size() == 3);
    CHECK(free_sample[1] == generate(tuned.cdbns[1], seeds, free_run));
    for (std::size_t m = 0; m < 3; ++m) REQUIRE(free_sample[m].size() == 4);
    MatrixF lead(seeds[1].rows() + 12, seeds[1].cols());
    lead << seeds[1], free_sample[1][3];
    const MatrixF first = regenerate(tuned, {{}, {lead}, {}}, 0).front();
    CHECK(free_sample[0][3] == first.bottomRows(12));
    CHECK(free_sample[2][3] == regenerate(tuned, {{first}, {lead}, {}}, 2).front().bottomRows(12));
    CHECK_THROWS_AS(generate(tuned, 3, seeds, free_run), ShapeError);

    // It comes back from a file of its own, without a skeleton.
    const ScratchFolder folder;
    save_machine(folder / "network.safetensors", {tuned});
    const SavedMachine saved = load_machine(device, folder / "network.safetensors");
    REQUIRE(std::holds_alternative<Mcdbn>(saved.machine));
    const Mcdbn& again = std::get<Mcdbn>(saved.machine);
    std::vector<std::vector<MatrixF>> two;
    for (const ModalityClips& modality : clips.modalities)
      two.emplace_back(modality.clips.begin(), modality.clips.end());
    two[2].clear();
    CHECK(regenerate(again, two, 2) == regenerate(tuned, two, 2));
    CHECK(again.modality(1).name == "two");

    // Its free energy is the MRBM's on codes that belong together.
    std::vector<Sequences> sequences;
    std::vector<Matrix> codes;
    for (std::size_t m = 0; m < 3; ++m) {
      sequences.push_back(Sequences::from_host(device, clips.modalities[m].clips));
      codes.push_back(tuned.cdbns[m].up_pass(sequences[m]).values);
    }
    const Sequences energies = free_energy(tuned, sequences);
    REQUIRE(energies.valid_from == 2);
    const std::size_t row = 31 + 7;  // in the second clip
    const MatrixF want = free_energy(tuned.mrbm, {Rows(codes[0], row + 1, 1),
                                                  Rows(codes[1], row, 1), Rows(codes[2], row, 1)})
                             .to_host();
    CHECK(energies.values.to_host()(static_cast<Eigen::Index>(row), 0) == want(0, 0));
    for (const MatrixF& clip : energies.to_host())
      for (Eigen::Index t = 0; t < clip.rows(); ++t)
        CHECK(std::isnan(clip(t, 0)) == (t < 2 || t == clip.rows() - 1));
  });
}

TEST_CASE("a lowest layer of binary units is learnt and fine-tuned: it predicts probabilities") {
  std::vector<ModalityMatrices> modalities = three_modalities();
  modalities.pop_back();
  for (MatrixF& clip : modalities[0].clips) clip = (clip.array() > 0).cast<float>();
  modalities[0].kind = kBinary;
  const MatrixSource source(std::move(modalities));
  LearningSettings settings = small_settings();
  settings.hidden = settings.mrbm_hidden = 16;
  settings.fine_tuning.steps = 300;
  settings.fine_tuning.rate = 2e-2;
  settings.fine_tuning.reverse = 1.0;
  const SequenceLossMaker squares = [](Device& device, const SequenceWindows& windows) {
    return std::make_unique<SquaredLoss>(device, windows, 1.0);
  };
  on_every_device([&](Device& device) {
    const Mcdbn greedy = train_greedy(device, source, settings);
    CHECK(greedy.cdbns[0].layers[0].shape().kind == kBinary);
    CHECK(greedy.cdbns[1].layers[0].shape().kind == kGaussian);
    const auto clips = source.sequences().modalities;
    const auto error_of = [&](const Mcdbn& network) {
      const MatrixF answer = regenerate(network, {{}, {clips[1].clips[1]}}, 0).front();
      CHECK(answer.minCoeff() >= 0.0F);  // probabilities
      CHECK(answer.maxCoeff() <= 1.0F);
      return (answer - clips[0].clips[1]).squaredNorm() / static_cast<float>(answer.size());
    };
    const Mcdbn tuned = fine_tune(device, greedy, source, nullptr, settings, squares).network;
    CHECK(tuned.cdbns[0].layers[0].shape().kind == kBinary);
    CHECK(error_of(tuned) < 0.8F * error_of(greedy));
    CHECK(error_of(tuned) < 0.2F);  // a half everywhere has 0.25
  });
}

TEST_CASE("one modality, or two of one name, are refused before anything is trained") {
  on_every_device([](Device& device) {
    std::size_t epochs = 0;
    const auto train = [&](std::vector<ModalityMatrices> modalities) {
      train_greedy(device, MatrixSource(std::move(modalities)), small_settings(),
                   [&](const EpochReport&) { ++epochs; });
    };
    std::vector<ModalityMatrices> modalities = three_modalities();
    CHECK_THROWS_AS(train({modalities[0]}), ShapeError);
    modalities[2].name = modalities[0].name;
    CHECK_THROWS_AS(train(modalities), ShapeError);
    CHECK(epochs == 0);
  });
}

}  // namespace modalities_test
