#include "learning/divergence_guard.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <string>
#include <vector>

#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

namespace {

/// The number of the first epoch at which the guard stops a run with these losses; 0: it does not.
std::size_t stopped_at(const std::vector<double>& losses) {
  DivergenceGuard guard("pose.0", "lower it");
  for (std::size_t epoch = 1; epoch <= losses.size(); ++epoch) {
    try {
      guard.check(epoch, losses[epoch - 1]);
    } catch (const DivergenceError&) {
      return epoch;
    }
  }
  return 0;
}

std::string message_of(const std::vector<double>& losses) {
  DivergenceGuard guard("track.1", "lower the rate");
  std::size_t epoch = 6;
  try {
    for (const double loss : losses) guard.check(++epoch, loss);
  } catch (const DivergenceError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("the guard stops a loss of more than four times the best so far") {
  CHECK(stopped_at({1.0, 4.0, 4.001}) == 3);
  CHECK(stopped_at({0.5, 2.0}) == 0);
  CHECK(stopped_at({0.5, 2.01}) == 2);
  // The best counts, neither the first nor the last.
  CHECK(stopped_at({1.0, 0.1, 0.3, 0.41}) == 4);
  CHECK(stopped_at({1.0, 0.1, 0.3, 0.39}) == 0);
  CHECK(stopped_at({1.0, 3.0, 3.9, 4.1}) == 4);
  CHECK(stopped_at({8.0, 1.0, 3.9, 2.0, 3.9}) == 0);
  CHECK(stopped_at({1e-12, 5e-12}) == 2);
}

TEST_CASE("the guard leaves a run alone that goes down, stays or wavers") {
  CHECK(stopped_at({100.0, 10.0, 1.0, 0.1, 0.01}) == 0);
  CHECK(stopped_at({1.0, 1.0, 1.0}) == 0);
  CHECK(stopped_at({1.0, 1.5, 0.9, 1.4, 0.8, 2.0}) == 0);
  CHECK(stopped_at({1e9}) == 0);  // nothing to compare the first with
}

TEST_CASE("the guard stops a loss that is no number or infinite, at the first epoch too") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    CHECK(stopped_at({bad}) == 1);
    CHECK(stopped_at({1.0, 0.5, bad}) == 3);
  }
}

TEST_CASE("the guard names stage, epoch, loss, the best so far and what to lower") {
  CHECK(message_of({0.75, 0.5, 0.625, 12.5}) ==
        "training diverged in stage track.1 at epoch 10: the loss is 12.5, the best was 0.5; "
        "lower the rate");
  CHECK(message_of({std::numeric_limits<double>::infinity()}) ==
        "training diverged in stage track.1 at epoch 7: the loss is inf; lower the rate");
}
