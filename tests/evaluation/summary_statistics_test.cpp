#include "evaluation/summary_statistics.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "clips.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

TEST_CASE("summarize: by hand") {
  const SummaryStatistics summary = summarize({4, 1, 3, 3, 9, NAN, 4, INFINITY, 4}, 4);
  CHECK(summary.count == 7);
  CHECK(summary.left_out == 2);
  CHECK(summary.mean == doctest::Approx(4));
  CHECK(summary.standard_deviation == doctest::Approx(std::sqrt(36.0 / 6)));
  CHECK(summary.median == 4);
  CHECK(summary.minimum == 1);
  CHECK(summary.maximum == 9);
  // Bins 1–3, 3–5, 5–7, 7–9.
  CHECK(summary.histogram.counts == std::vector<int>{1, 5, 0, 1});
  CHECK(summary.mode == doctest::Approx(4));
  CHECK(summary.histogram.bin_width() == doctest::Approx(2));
  CHECK(summarize({2, 1, 10, 3}, 20).median == doctest::Approx(2.5));
}

TEST_CASE("summarize: nothing, one value, equal values") {
  const SummaryStatistics none = summarize({NAN}, 20);
  CHECK(none.count == 0);
  CHECK(none.left_out == 1);
  CHECK(std::isnan(none.mean));
  CHECK(std::isnan(none.minimum));
  CHECK(none.histogram.counts.empty());
  const SummaryStatistics one = summarize({0.7}, 20);
  CHECK(one.mode == doctest::Approx(0.7));
  CHECK(one.median == 0.7);
  CHECK(std::isnan(one.standard_deviation));
  CHECK(summarize({0.7, 0.7, 0.7}, 20).standard_deviation == doctest::Approx(0));
}

TEST_CASE("histogram_of: every value within the range is in the bin around it") {
  const MatrixD draws = test::random_clip(5000, 1, 1, 3);
  const std::vector<double> values(draws.data(), draws.data() + draws.size());
  const Histogram histogram = histogram_of(values, -1.5, 2, 13);
  REQUIRE(histogram.counts.size() == 13);
  for (int bin = 0; bin < 13; ++bin) {
    const double low = -1.5 + bin * 3.5 / 13, high = low + 3.5 / 13;
    int expected = 0;
    for (const double value : values) expected += value >= low && value < high;
    CHECK(histogram.counts[static_cast<std::size_t>(bin)] == expected);
    CHECK(histogram.bin_centre(bin) == doctest::Approx(0.5 * (low + high)));
  }
  CHECK(histogram_of({2.0, 2.1, NAN}, 1, 2, 4).counts == std::vector<int>{0, 0, 0, 1});
  CHECK_THROWS_AS(histogram_of(values, 0, 1, 0), ConfigError);
  CHECK_THROWS_AS(histogram_of(values, 1, 0, 5), ConfigError);
}

}  // namespace mcdbn
