#include "mcdbn/machines/generation_health.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "base/random_matrix.hpp"
#include "mcdbn/base/errors.hpp"

namespace generation_health_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Channels that swing with that period, half of them twice as fast, as left and right limbs are
/// seen together.
MatrixF swinging(Eigen::Index frames, double period) {
  MatrixF values(frames, 4);
  for (Eigen::Index t = 0; t < frames; ++t)
    for (Eigen::Index c = 0; c < 4; ++c)
      values(t, c) = static_cast<float>(
          std::sin(2 * EIGEN_PI * (c < 3 ? 1.0 : 2.0) * static_cast<double>(t) / period + c));
  return values;
}

}  // namespace

TEST_CASE("generation health: the shortest cycle is the period") {
  for (const int period : {9, 31, 32, 80, 89})
    CHECK(shortest_cycle(swinging(400, period)) == static_cast<std::size_t>(period));
  // Of the longest lag it is not known what follows.
  CHECK(shortest_cycle(swinging(400, kLongestLag)) == 0);
  for (const int period : {9, 31, 80}) {  // it has to be seen twice
    CHECK(shortest_cycle(swinging(2 * period, period)) == static_cast<std::size_t>(period));
    CHECK(shortest_cycle(swinging(2 * period - 2, period)) == 0);
  }
  // With noise on it, too.
  CHECK(shortest_cycle(swinging(400, 31) + random_matrix(400, 4, 1, 0.2F)) == 31);
}

TEST_CASE("generation health: what stands, shakes or runs away has no cycle") {
  CHECK(shortest_cycle(MatrixF::Ones(300, 3)) == 0);
  CHECK(shortest_cycle(random_matrix(300, 3, 2)) == 0);
  MatrixF line(300, 2);
  for (Eigen::Index t = 0; t < line.rows(); ++t) line.row(t).setConstant(static_cast<float>(t));
  for (const Eigen::Index frames : {2, 3, 4, 10, 30, 60, 89, 90, 300}) {
    CAPTURE(frames);
    CHECK(shortest_cycle(line.topRows(frames)) == 0);
  }
  CHECK(shortest_cycle(MatrixF(0, 3)) == 0);
  CHECK(shortest_cycle(MatrixF::Ones(1, 3)) == 0);
}

TEST_CASE("generation health: the shortest cycle is that of those that have one") {
  GenerationHealth health;
  CHECK(health.shortest_of_cycles() == 0);
  health.cycle = {0, 0};
  CHECK(health.shortest_of_cycles() == 0);
  health.cycle = {0, 40, 31, 0, 35};
  CHECK(health.shortest_of_cycles() == 31);
}

TEST_CASE("generation health: deviations over all sequences, speed at the end of each") {
  MatrixF stops = swinging(500, 25);
  stops.bottomRows(300).rowwise() = MatrixF(stops.row(200)).row(0);
  const std::vector<MatrixF> sequences{swinging(500, 25), stops};
  const GenerationHealth health = generation_health(sequences);
  REQUIRE(health.late_speed.size() == 2);
  // RMS of sin(x + δ) − sin(x) is √2 · sin(δ/2); three channels turn by δ a frame, one by 2δ.
  const double turn = EIGEN_PI / 25;
  const double speed =
      std::sqrt((3 * std::pow(std::sin(turn), 2) + std::pow(std::sin(2 * turn), 2)) / 2);
  CHECK(health.late_speed[0] == doctest::Approx(speed).epsilon(0.01));
  CHECK(health.late_speed[1] == 0);
  CHECK(health.cycle == std::vector<std::size_t>{25, shortest_cycle(stops)});
  MatrixD all(1000, 4);
  all << sequences[0].cast<double>(), sequences[1].cast<double>();
  const RowVectorD centred = (all.rowwise() - all.colwise().mean()).colwise().norm();
  CHECK((health.deviation - centred / std::sqrt(1000.0)).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(generation_health({}).deviation.size() == 0);
}

TEST_CASE("generation health: what ends at less than half its seed's speed is slow") {
  const MatrixF seed = swinging(100, 25), faster = swinging(100, 20);
  const auto slowed = [&](float factor) { return MatrixF(factor * swinging(300, 25)); };
  const double usual = mean_speed(seed), fast = mean_speed(faster);
  const GenerationHealth health = generation_health(
      {slowed(1.0F), slowed(0.49F), slowed(0.51F), slowed(0.3F)}, {usual, usual, fast, fast});
  CHECK(health.seed_speed == std::vector<double>{usual, usual, fast, fast});
  CHECK(usual == doctest::Approx(health.late_speed[0]).epsilon(0.01));
  CHECK(fast > 1.1 * usual);
  CHECK(health.slow_sequences() == 3);  // 0.51 is slow beside the faster seed
  CHECK(generation_health({seed}).slow_sequences() == 0);
  CHECK_THROWS_AS(generation_health({seed, seed, seed}, {usual, usual}), ShapeError);
}

}  // namespace generation_health_test
