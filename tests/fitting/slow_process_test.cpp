#include "fitting/slow_process.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>

using namespace mcdbn;

TEST_CASE("slow process: it has variance 1 and forgets in the time that it is given") {
  constexpr int kFrames = 301, kMiddle = 150;
  for (const double frame_time_s : {1.0 / 30, 1.0 / 60}) {
    CAPTURE(frame_time_s);
    constexpr double kTime_s = 0.2;
    const SlowProcess process(kTime_s, frame_time_s);
    Eigen::MatrixXd precision = process.value_weight * Eigen::MatrixXd::Identity(kFrames, kFrames);
    for (int t = 1; t + 1 < kFrames; ++t)
      precision.block<3, 3>(t - 1, t - 1) +=
          process.curvature_weight * Eigen::Vector3d(1, -2, 1) * Eigen::RowVector3d(1, -2, 1);
    const Eigen::VectorXd correlation = precision.inverse().col(kMiddle);
    CHECK(correlation[kMiddle] == doctest::Approx(1).epsilon(0.02));
    const auto after = [&](double seconds) {
      return correlation[kMiddle + static_cast<int>(std::lround(seconds / frame_time_s))];
    };
    CHECK(after(kTime_s) == doctest::Approx(0.70).epsilon(0.03));
    CHECK(std::abs(after(3.33 * kTime_s)) < 0.05);
  }
}
