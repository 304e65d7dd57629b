// Trains a Gaussian CRBM on a matrix, one frame a row: two waves that follow largely from the past.
#include <cmath>
#include <iostream>
#include <mcdbn/base/errors.hpp>
#include <mcdbn/learning/greedy_schedule.hpp>

int main() {
  mcdbn::MatrixF frames(400, 2);
  for (int t = 0; t < frames.rows(); ++t) {
    frames.row(t) << std::sqrt(2.0F) * std::sin(0.2F * t), std::sqrt(2.0F) * std::cos(0.3F * t);
  }
  try {
    mcdbn::Device device = mcdbn::Device::open();
    const mcdbn::CrbmShape shape{.visible = 2, .hidden = 16, .order = 3};
    const mcdbn::CdSettings settings{.rate = 1e-2, .rate_A = 1e-3, .rate_B = 1e-3, .epochs = 60};

    double first_loss = 0, last_loss = 0;
    const auto watch = [&](const mcdbn::EpochReport& report) {
      if (report.epoch == 1) first_loss = report.loss;
      last_loss = report.loss;
    };
    const mcdbn::Crbm crbm =
        mcdbn::train_crbm(device, mcdbn::Sequences::from_host(device, {frames}),
                          mcdbn::CrbmParameters::random(shape, settings.initial_deviation, {}),
                          settings, mcdbn::LearningSettings{}, /*stream=*/0, watch);

    const mcdbn::CrbmParameters learned = crbm.to_host();
    std::cout << "error " << first_loss << " -> " << last_loss << ", W\n" << learned.W << '\n';
    return last_loss < 0.5 * first_loss && learned.W.allFinite() ? 0 : 1;
  } catch (const mcdbn::DeviceError& error) {
    std::cerr << error.what() << '\n';
    return 4;
  }
}
