#include "base/random_sequence.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <set>

using namespace mcdbn;

TEST_CASE("a sequence draws Philox's numbers in order, another seed or stream others") {
  RandomSequence sequence(7, 3);
  const RandomKey key{7, 0, 3, 0};
  for (std::uint32_t i = 0; i < 10; ++i) {
    const std::uint64_t high = random_bits(key, 2 * i, 0) >> 5,
                        low = random_bits(key, 2 * i + 1, 0) >> 6;
    CHECK(sequence.uniform() == std::ldexp(static_cast<double>(high * (1 << 26) + low), -53));
  }
  CHECK(RandomSequence(7, 3).uniform() != RandomSequence(7, 4).uniform());
  CHECK(RandomSequence(7, 3).uniform() != RandomSequence(8, 3).uniform());
}

TEST_CASE("draws of a sequence have their distributions' moments") {
  constexpr int kDraws = 20000;
  const double deviation = 1.0 / std::sqrt(kDraws);
  RandomSequence sequence(1);
  double sum = 0, squares = 0, uniform = 0, heads = 0;
  std::array<int, 3> counts{};
  for (int i = 0; i < kDraws; ++i) {
    const double x = sequence.normal();
    sum += x / kDraws;
    squares += x * x / kDraws;
    const double u = sequence.uniform(2, 4);
    CHECK((u >= 2 && u < 4));
    uniform += u / kDraws;
    heads += sequence.chance(0.3) ? 1.0 / kDraws : 0.0;
    ++counts.at(sequence.below(3));
  }
  // Five deviations of each mean.
  CHECK(std::abs(sum) < 5 * deviation);
  CHECK(std::abs(squares - 1) < 5 * std::sqrt(2.0) * deviation);
  CHECK(std::abs(uniform - 3) < 5 * 2 / std::sqrt(12.0) * deviation);
  CHECK(std::abs(heads - 0.3) < 5 * std::sqrt(0.21) * deviation);
  for (const int count : counts)
    CHECK(std::abs(count - kDraws / 3.0) < 5 * std::sqrt(kDraws * 2.0 / 9.0));
}

TEST_CASE("mixed seeds of neighbours and of other orders differ") {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t a = 0; a < 10; ++a)
    for (std::uint64_t b = 0; b < 10; ++b) seeds.insert(mixed_seed({a, b}));
  CHECK(seeds.size() == 100);
}
