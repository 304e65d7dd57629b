#include "fitting/robust_residuals.hpp"

#include <doctest/doctest.h>

#include <random>

using namespace mcdbn;

TEST_CASE("robust residuals: the deviation of normal noise, whatever a twentieth of it does") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 2.5);
  std::vector<double> noise(20001);
  for (double& value : noise) value = normal(random);
  CHECK(robust_deviation(noise) == doctest::Approx(2.5).epsilon(0.03));
  for (std::size_t i = 0; i < noise.size() / 20; ++i) noise[i] = 1e6;
  CHECK(robust_deviation(noise) < 1.1 * 2.5);
  CHECK(robust_deviation({}) == 0);
  CHECK(robust_deviation({-1, -1, -1}) == doctest::Approx(1.4826));
}
