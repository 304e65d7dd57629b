// An MRBM of three modalities on matrices: the third is inferred from the other two.
#include <iostream>
#include <mcdbn/base/errors.hpp>
#include <mcdbn/learning/greedy_schedule.hpp>

using namespace mcdbn;

int main() {
  // Eight units in each modality; a unit follows one of three hidden causes.
  MrbmShape shape{{{"sight", 8}, {"sound", 8}, {"touch", 8}}, 12};
  std::vector<MatrixF> data(3, MatrixF(500, 8));
  for (std::uint32_t row = 0; row < 500; ++row)
    for (std::uint32_t m = 0; m < 3; ++m)
      for (std::uint32_t unit = 0; unit < 8; ++unit)
        data[m](row, unit) = random_uniform({1}, row, (unit + m) % 3) < 0.5F ? 1.0F : 0.0F;
  try {
    Device device = Device::open();
    LearningSettings settings;
    settings.look_ahead = 0;
    settings.mrbm.rate = 1e-2;
    settings.mrbm.epochs = 20;
    std::vector<Sequences> sequences;
    for (const MatrixF& modality : data)
      sequences.push_back(Sequences::from_host(device, {modality}));
    const Mrbm mrbm = train_mrbm(device, sequences, MrbmParameters::random(shape, 0.1, {1}),
                                 settings, /*stream=*/0);

    const Matrix inferred(device, 500, 8);
    mrbm.infer({sequences[0].values, sequences[1].values, inferred}, {true, true, false}, 5);
    const float error = (inferred.to_host() - data[2]).cwiseAbs().mean();
    std::cout << "mean error of touch from sight and sound: " << error << '\n';
    return error < 0.1F ? 0 : 1;
  } catch (const DeviceError& problem) {
    std::cerr << problem.what() << '\n';
    return 4;
  }
}
