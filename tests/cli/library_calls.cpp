#include "library_calls.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"

#include <memory>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "fitting/blas_kernels.hpp"
#include "mcdbn/corpus/training_clips.hpp"
#include "motion_model/sample_calibration.hpp"

namespace mcdbn::test {
namespace {

/// As the program has it: what is compared with its files takes the same kernels.
[[maybe_unused]] const bool kKernelsChosen = (choose_blas_kernels(), true);

}  // namespace

Device& usual_device() {
  static Device& device = *std::make_unique<Device>(Device::open()).release();
  return device;
}

LibraryTraining train_by_library(const std::vector<std::filesystem::path>& clips,
                                 const TrainingConfig& config, const nlohmann::json& record) {
  LibraryTraining result;
  std::vector<std::string> notices;
  const auto loaded = load_training_clips({clips.begin(), clips.end()}, config, &notices);
  const TrainingSet data = make_training_set(loaded, config);
  auto [network, stopped] =
      train_network(usual_device(), data, loaded, config,
                    [&](const EpochReport& report) { result.epochs.push_back(report); });
  if (config.fine_tuning.steps > 0)
    network.sampling = calibrated_sampling(network, data.modalities, data.tracks, data.poses);
  const ScratchFolder folder;
  save_model(folder / "model.safetensors",
             {std::move(network), data.modalities, data.clips, record, std::move(stopped)},
             config.half_precision ? StoredNumbers::half : StoredNumbers::single);
  result.model_file = read_text_file(folder / "model.safetensors");
  return result;
}

}  // namespace mcdbn::test
