#include "machines/mrbm_chain.hpp"

#include <doctest/doctest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <sstream>

#include "device/every_device.hpp"
#include "device/fitting_tiles.hpp"
#include "device/gemm.hpp"
#include "machines/two_modalities.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/error_bounds.hpp"
#include "reference/mrbm_chain_reference.hpp"

namespace mrbm_chain_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::Bounded;
using reference::misfit;

namespace {

struct Case {
  std::size_t track, pose, hidden, rows, steps;
};

const std::vector<Case> kSmallCases = {{1, 1, 1, 1, 1}, {4, 3, 7, 3, 5}, {17, 13, 1, 13, 3}};
const std::vector<Case> kCases = {{33, 17, 257, 29, 3}, {300, 300, 150, 103, 3}};
const Case kOddCase{17, 33, 19, 29, 3};
constexpr std::array<std::size_t, 2> kModalities{modality::track, modality::pose};
constexpr std::uint64_t kSeed = 0x123456789ABCDEFULL;

/// An MRBM and codes to clamp, the same every time.
struct Problem {
  explicit Problem(const Case& test)
      : test(test),
        parameters(MrbmParameters::zeros(two_modalities(test.track, test.pose, test.hidden))) {
    const float scale = 1.0F / std::sqrt(static_cast<float>(test.hidden));
    const std::array<std::size_t, 2> visible{test.track, test.pose};
    for (std::size_t m = 0; m < 2; ++m) {
      const auto seed = static_cast<unsigned>(10 * m);
      parameters.W[m] = random_matrix(visible[m], test.hidden, seed + 1, scale);
      parameters.a[m] = random_matrix(1, visible[m], seed + 2);
      codes[m] = (0.5F * (random_matrix(test.rows, visible[m], seed + 3).array() + 1.0F)).matrix();
    }
    parameters.b = random_matrix(1, test.hidden, 30);
  }

  reference::Mrbm model() const {
    return {{parameters.W[0].cast<double>(), parameters.W[1].cast<double>()},
            {parameters.a[0].cast<double>(), parameters.a[1].cast<double>()},
            parameters.b.cast<double>()};
  }

  MrbmChainOptions options(float temperature) const {
    return {test.steps, temperature, Sampling::bernoulli, {kSeed, 7, 3, 0}};
  }

  Bounded want(std::size_t present, const MrbmChainOptions& options) const {
    const MatrixD values = codes[present].cast<double>();
    const reference::ClampedChain chain{static_cast<int>(options.steps),
                                        static_cast<double>(options.temperature),
                                        options.sampling == Sampling::concrete};
    return reference::bounded_clamped_chain(
        model(), static_cast<int>(present), values, chain, [&](int pass, Eigen::Index units) {
          RandomKey key = options.random;
          const int phase = key.phase + pass;  // 0x4000 of them, then the next step
          key.phase = static_cast<std::uint16_t>(phase & 0x3fff);
          key.step += static_cast<std::uint32_t>(phase >> 14) * options.steps_apart;
          MatrixD u(values.rows(), units);
          for (Eigen::Index r = 0; r < u.rows(); ++r)
            for (Eigen::Index c = 0; c < u.cols(); ++c)
              u(r, c) =
                  random_uniform(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
          return u;
        });
  }

  Case test;
  MrbmParameters parameters;
  std::array<MatrixF, 2> codes;
};

std::optional<RowTile> chosen_tile(Device& device, const Problem& problem) {
  return MrbmChain(Mrbm(device, problem.parameters), only(modality::track), problem.test.rows)
      .tile();
}

/// Into rows between guards; nothing around them may change.
MatrixF run(Device& device, const Problem& problem, std::size_t present,
            const MrbmChainOptions& options, const std::optional<RowTile>& tile) {
  const Mrbm mrbm(device, problem.parameters);
  const Matrix codes = Matrix::from_host(device, problem.codes[present]);
  MrbmChain chain(mrbm, only(present), problem.test.rows, tile);
  const GuardedBlock absent(device, problem.test.rows, mrbm.visible(other(present)));
  const auto before = device.launch_count();
  chain.run(in_order(present, codes, absent.rows()), options);
  if (tile) CHECK(device.launch_count() - before == 1);
  CHECK(absent.intact());
  return absent.values();
}

/// Row by row: where rounding may decide a draw, nothing is known and nothing checked.
/// @return the share of the rows that were
double check_rows(const MatrixF& got, const Bounded& want) {
  constexpr double kUseful = 1e-2;
  Eigen::Index checked = 0;
  for (Eigen::Index r = 0; r < got.rows(); ++r) {
    if (!(want.bound.row(r).maxCoeff() < kUseful)) continue;
    ++checked;
    CAPTURE(r);
    CHECK(misfit(got.row(r), want.value.row(r), want.bound.row(r)) == "");
  }
  return static_cast<double>(checked) / static_cast<double>(got.rows());
}

/// @param phase the first; far on, it is that of a long chain
void check_against_reference(Device& device, const std::vector<Case>& cases, float temperature,
                             Sampling sampling = Sampling::bernoulli, std::uint16_t phase = 0) {
  for (const Case& test : cases)
    for (const std::size_t present : kModalities) {
      const Problem problem(test);
      INFO(test.track, " + ", test.pose, " / ", test.hidden, ", rows ", test.rows, ", present ",
           present, ", temperature ", temperature);
      MrbmChainOptions options = problem.options(temperature);
      options.sampling = sampling;
      options.random.phase = phase;
      options.steps_apart = 5;
      const Bounded want = problem.want(present, options);
      const auto tile = chosen_tile(device, problem);
      REQUIRE(tile);
      const MatrixF fused = run(device, problem, present, options, tile);
      const bool jumps = temperature != 0.0F && sampling == Sampling::bernoulli;
      const double least = jumps ? 0.5 : 1.0;
      CHECK(check_rows(fused, want) >= least);
      const MatrixF composed = run(device, problem, present, options, std::nullopt);
      CHECK(check_rows(composed, want) >= least);
      if (device.tuning().clblast_from == 0) CHECK(fused == composed);
    }
}

}  // namespace

TEST_CASE("small: the clamped chain's mean field, fused and composed, is eq 32 and 33 in double") {
  on_every_device([](Device& device) { check_against_reference(device, kSmallCases, 0.0F); });
}

TEST_CASE("small: the sampled clamped chain is the reference's with the same draws") {
  on_every_device([](Device& device) {
    check_against_reference(device, kSmallCases, 1.0F);
    check_against_reference(device, kSmallCases, 0.3F);
  });
}

TEST_CASE("small: the chain with concrete draws is the reference's, every row of it") {
  on_every_device([](Device& device) {
    for (const float temperature : {1.0F, 0.3F})
      check_against_reference(device, kSmallCases, temperature, Sampling::concrete);
    check_against_reference(device, {kOddCase}, 1.0F, Sampling::concrete);
  });
}

TEST_CASE("small: a long chain's draws are of further steps, not the first ones again") {
  on_every_device([](Device& device) {
    for (const unsigned phase : {0x3ffeU, 0x3fffU, 0x7fffU, 0xfffdU})
      check_against_reference(device, {kSmallCases[1]}, 1.0F, Sampling::concrete,
                              static_cast<std::uint16_t>(phase));
  });
}

TEST_CASE("the clamped chain at odd and at the model's sizes, within rounding") {
  on_every_device([](Device& device) {
    for (const float temperature : {0.0F, 1.0F})
      check_against_reference(device, kCases, temperature);
  });
}

TEST_CASE("small: work-items that share a block of the clamped chain wait for each other") {
  on_every_device([](Device& device) {
    const Problem problem(kSmallCases[1]);
    const MrbmChainOptions options = problem.options(0.5F);
    const MatrixF want =
        run(device, problem, modality::pose, options, chosen_tile(device, problem));
    for (const RowTile& tile : fitting_tiles(device, {{4, 3, 1, 4, 4}}))
      CHECK(run(device, problem, modality::pose, options, tile) == want);
  });
}

TEST_CASE("every tile of the clamped chain gives the same bits") {
  on_every_device([](Device& device) {
    const Problem problem(kOddCase);
    const MrbmChainOptions options = problem.options(0.5F);
    const MatrixF want = run(device, problem, modality::pose, options, RowTile{});
    CHECK(check_rows(want, problem.want(modality::pose, options)) >= 0.5);
    const auto check = [&](const std::optional<RowTile>& tile) {
      CHECK(run(device, problem, modality::pose, options, tile) == want);
    };
    for (const RowTile& tile : fitting_tiles(
             device, {{16, 7, 2, 1, 8}, {8, 14, 1, 1, 4}, {4, 4, 1, 32, 4}, {1, 3, 1, 64, 16}})) {
      CAPTURE(tile.vector_width);
      CAPTURE(tile.rows);
      CAPTURE(tile.group);
      check(tile);
    }
    const Tuning usual = device.tuning();
    for (const Tuning& tuning : tuning_candidates(device.info(), default_tuning(device.info()))) {
      CAPTURE(tuning.vector_width);
      CAPTURE(tuning.largest_rows);
      CAPTURE(tuning.accumulators);
      device.set_tuning(tuning);
      check(chosen_tile(device, problem));
    }
    device.set_tuning(usual);
  });
}

TEST_CASE("small: rows by index, by step, fewer than the chain was made for") {
  on_every_device([](Device& device) {
    const Problem problem(kSmallCases[1]);
    const MrbmChainOptions options = problem.options(1.0F);
    const Mrbm mrbm(device, problem.parameters);
    const MatrixF& codes = problem.codes[0];  // three rows
    MatrixF spread = random_matrix(9, static_cast<std::size_t>(codes.cols()), 77);
    for (const Eigen::Index r : {0, 1, 2}) spread.row(2 + 3 * r) = codes.row(r);
    const Matrix all = Matrix::from_host(device, spread);
    const IndexBuffer index(device, {99, 1, 4, 7});
    for (const auto& tile : {chosen_tile(device, problem), std::optional<RowTile>()}) {
      const MatrixF want = run(device, problem, modality::track, options, tile);
      MrbmChain chain(mrbm, {true, false}, 11, tile);
      Matrix absent(device, 9, 3);
      chain.run({Rows::indexed(all, index, 1, 3, 1), Rows::strided(absent, 1, 3, 3)}, options);
      MatrixF got = absent.to_host();
      for (const Eigen::Index r : {0, 1, 2}) {
        CHECK(got.row(1 + 3 * r) == want.row(r));
        got.row(1 + 3 * r).setZero();
      }
      CHECK(got == MatrixF::Zero(9, 3));
      chain.run({Rows::strided(all, 2, 3, 3), Rows(absent, 6, 3)}, options);
      CHECK(absent.to_host().bottomRows(3) == want);
    }
  });
}

TEST_CASE("small: same seed, same bits; another seed, others; no temperature, no draws") {
  on_every_device([](Device& device) {
    const Problem problem(kSmallCases[2]);
    for (const auto& tile : {chosen_tile(device, problem), std::optional<RowTile>()}) {
      const auto sample = [&](float temperature, std::uint64_t seed) {
        MrbmChainOptions options = problem.options(temperature);
        options.random.seed = seed;
        return run(device, problem, modality::pose, options, tile);
      };
      CHECK(sample(1.0F, 1) == sample(1.0F, 1));
      CHECK(sample(1.0F, 1) != sample(1.0F, 2));
      CHECK(sample(0.0F, 1) == sample(0.0F, 2));
    }
  });
}

TEST_CASE("MRBM inference is the chain's mean field") {
  on_every_device([](Device& device) {
    const Problem problem(kOddCase);
    const Mrbm mrbm(device, problem.parameters);
    const Matrix codes = Matrix::from_host(device, problem.codes[0]);
    const Matrix pose(device, problem.test.rows, problem.test.pose);
    mrbm.infer({codes, pose}, {true, false}, problem.test.steps);
    const auto tile = chosen_tile(device, problem);
    CHECK(pose.to_host() == run(device, problem, modality::track, problem.options(0.0F), tile));
    mrbm.infer({codes, pose}, {true, false}, 0);  // as one step
    const MatrixF none = pose.to_host();
    mrbm.infer({codes, pose}, {true, false}, 1);
    CHECK(none == pose.to_host());
  });
}

TEST_CASE("where a row does not fit local memory the clamped chain is composed") {
  on_every_device([](Device& device) {
    const Case test{5, 3, device.info().local_memory_bytes / sizeof(float), 3, 2};
    std::ostringstream messages;
    const auto usual = spdlog::default_logger();
    auto logger = std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_st>(messages));
    logger->set_level(spdlog::level::debug);
    spdlog::set_default_logger(logger);
    const Problem problem(test);
    const Mrbm mrbm(device, problem.parameters);
    MrbmChain chain(mrbm, {true, false}, test.rows);
    spdlog::set_default_logger(usual);
    CHECK(messages.str().find("composed kernels instead") != std::string::npos);
    CHECK_FALSE(chain.tile());
    const Matrix codes = Matrix::from_host(device, problem.codes[0]);
    const Matrix pose(device, test.rows, test.pose);
    chain.run({codes, pose}, problem.options(1.0F));
    CHECK(pose.to_host().allFinite());
  });
}

TEST_CASE("small: the clamped chain refuses what it cannot do") {
  on_every_device([](Device& device) {
    const Problem problem(kSmallCases[1]);  // 4 + 3 / 7
    const Mrbm mrbm(device, problem.parameters);
    MrbmChain chain(mrbm, {true, false}, 5);
    const Matrix track(device, 8, 4), pose(device, 8, 3);
    const IndexBuffer index(device, {0, 1, 2});
    const auto check = [&](const Rows& present, const Rows& absent, std::size_t steps = 1) {
      CHECK_THROWS_AS(chain.run({present, absent}, {.steps = steps, .temperature = 1.0F}),
                      ShapeError);
    };
    check(Rows(pose, 0, 3), Rows(track, 0, 3));
    check(Rows(track, 0, 3), Rows(track, 3, 3));
    check(Rows(track, 0, 3), Rows(pose, 0, 2));
    check(Rows(track, 0, 6), Rows(pose, 0, 6));
    check(Rows(track, 0, 3), Rows::indexed(pose, index, 0, 3));
    check(Rows(track, 0, 3), Rows(pose, 0, 3), 0);
    const auto before = device.launch_count();
    chain.run({Rows(track, 0, 0), Rows(pose, 0, 0)}, {});
    CHECK(device.launch_count() == before);
  });
}

}  // namespace mrbm_chain_test
