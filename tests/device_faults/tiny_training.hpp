#pragma once

#include <doctest/doctest.h>

#include "corpus/training_files.hpp"
#include "mcdbn/corpus/training_clips.hpp"
#include "mcdbn/motion_model/training_run.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"
#include "motion_model/tiny_training_config.hpp"
#include "opencl_layer/opencl_layer.hpp"

namespace mcdbn::test {

/// The driver as it is before a test and after it.
struct HealthyDriver {
  HealthyDriver() { set_up(); }
  ~HealthyDriver() { set_up(); }
  HealthyDriver(const HealthyDriver&) = delete;
  HealthyDriver& operator=(const HealthyDriver&) = delete;

 private:
  static void set_up() {
    layer::heal();
    layer::limit({});
  }
};

/// A whole training of motion, both stages, that takes a moment.
class TinyTraining {
 public:
  /// @return every parameter, one after another
  std::vector<MatrixF> train(Device& device) const {
    return bits_of(train_model(device, data_, clips_, config).model.network);
  }
  /// The same on the usual device, opened for this.
  std::vector<MatrixF> train() const {
    Device device = Device::open();
    return train(device);
  }
  /// With a checkpoint after each mini-batch.
  std::vector<MatrixF> train_to(RunFolder& run) const {
    Device device = Device::open();
    return bits_of(train_to_folder(device, data_, clips_, run, {.minutes = 0}).model.network);
  }
  std::vector<ListedClip> listed() const { return {walks_.files().begin(), walks_.files().end()}; }

  const TrainingConfig config = tiny_training_config();

 private:
  static std::vector<MatrixF> bits_of(const Mcdbn& network) {
    std::vector<MatrixF> bits;
    for (const Cdbn& cdbn : network.cdbns)
      for (const Crbm& layer : cdbn.layers)
        for (const char* name : {"W", "A", "B", "a", "b"})
          bits.push_back(layer.parameters().to_host(name));
    const MrbmParameters mrbm = network.mrbm.to_host();
    bits.insert(bits.end(), mrbm.W.begin(), mrbm.W.end());
    bits.push_back(mrbm.b);
    return bits;
  }

  TrainingFiles walks_{{{1, 1, 30.0, 1.2}, {2, 1, 30.0, 1.0}}};
  std::vector<LoadedClip> clips_ = load_clips(walks_.files());
  TrainingSet data_ = make_training_set(clips_, config);
};

}  // namespace mcdbn::test
