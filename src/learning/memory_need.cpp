#include "learning/memory_need.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/counted.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"
#include "mcdbn/machines/mrbm.hpp"

namespace mcdbn {
namespace {

double count_of(const std::vector<ParameterShape>& shapes) {
  double count = 0;
  for (const ParameterShape& shape : shapes)
    count += static_cast<double>(shape.rows) * static_cast<double>(shape.columns);
  return count;
}

/// Numbers that a frame of a window leaves behind in every layer of a modality.
double states_of(std::size_t dimension, const LearningSettings& settings) {
  return static_cast<double>(dimension) +
         2.0 * static_cast<double>(settings.layers * settings.hidden);
}

bool is_tuned(const LearningSettings& settings) {
  return settings.fine_tuning.steps > 0;
}

bool is_greedy(const LearningSettings& settings) {
  return !is_tuned(settings) || settings.fine_tuning.from_greedy;
}

/// Parameters of a machine of the greedy stages.
struct MachineSize {
  double parameters = 0;
  bool adam = false;
};

std::vector<MachineSize> machine_sizes(std::span<const std::size_t> dimensions,
                                       const LearningSettings& settings) {
  std::vector<MachineSize> sizes;
  MrbmShape mrbm{{}, settings.mrbm_hidden};
  for (const std::size_t dimension : dimensions) {
    for (const CrbmShape& shape : layer_shapes(dimension, settings, VisibleKind::gaussian))
      sizes.push_back({count_of(Crbm::parameter_shapes(shape)), shape.kind == VisibleKind::gaussian
                                                                    ? settings.gaussian.adam
                                                                    : settings.binary.adam});
    mrbm.modalities.push_back({{}, settings.hidden});
  }
  sizes.push_back({count_of(Mrbm::parameter_shapes(mrbm)), settings.mrbm.adam});
  return sizes;
}

/// Frames of a mini-batch of fine-tuning that settle or are judged.
double judged_frames(const FineTuningSettings& tuning) {
  return static_cast<double>(tuning.windows) *
         static_cast<double>(tuning.settle_frames + tuning.window_frames);
}

/// Those and the frames before them.
double frames_with_history(const LearningSettings& settings) {
  return judged_frames(settings.fine_tuning) +
         static_cast<double>(settings.fine_tuning.windows) *
             static_cast<double>(settings.layers * settings.order);
}

double fine_tuning_states(std::span<const std::size_t> dimensions,
                          const LearningSettings& settings) {
  double states = 0;
  for (const std::size_t dimension : dimensions)
    states += frames_with_history(settings) * states_of(dimension, settings);
  // Values and errors of the codes in every unrolled step (UnrolledPass).
  return states + judged_frames(settings.fine_tuning) * 2.0 *
                      static_cast<double>(settings.fine_tuning.mean_field_steps) *
                      static_cast<double>(settings.hidden + settings.mrbm_hidden);
}

/// The settings that the largest part of a need comes from, with their values.
std::string what_needs_less(const MemoryNeed& need, const LearningSettings& settings) {
  if (need.parameters >= std::max(need.windows, need.frames))
    return fmt::format("lower `hidden` (now {}), `mrbm-hidden` ({}), `order` ({}) or `layers` ({})",
                       settings.hidden, settings.mrbm_hidden, settings.order, settings.layers);
  if (need.windows >= need.frames)
    return fmt::format(
        "lower `batch` (now {}), `fine-tuning.windows` ({}), `fine-tuning.window-frames` ({}) or "
        "`fine-tuning.mean-field-steps` ({})",
        settings.batch, settings.fine_tuning.windows, settings.fine_tuning.window_frames,
        settings.fine_tuning.mean_field_steps);
  return "train on fewer clips, or lower `augment.views` or `hidden`";
}

}  // namespace

MemoryNeed memory_need(std::span<const std::size_t> dimensions, double frames,
                       const LearningSettings& settings) {
  double parameters = 0, batch = 0, rows = 0;
  for (const MachineSize& machine : machine_sizes(dimensions, settings))
    parameters += machine.parameters;
  for (const std::size_t dimension : dimensions) {
    batch = std::max(batch, static_cast<double>(settings.batch) * states_of(dimension, settings));
    rows += static_cast<double>(dimension);
  }
  const bool tunes = is_tuned(settings), greedy = is_greedy(settings);
  // The value and its step; Adam has two moments and fine-tuning a moving average and a gradient.
  const double copies = tunes ? 5 : 2;
  rows += static_cast<double>(dimensions.size() * settings.hidden);
  MemoryNeed need;
  need.parameters = sizeof(float) * copies * parameters;
  need.windows = sizeof(float) * std::max(greedy ? batch : 0.0,
                                          tunes ? fine_tuning_states(dimensions, settings) : 0.0);
  // Fine-tuning takes its windows from the host's memory.
  need.frames = greedy ? sizeof(float) * frames * rows : 0.0;
  return need;
}

MemoryNeed largest_buffers(std::span<const std::size_t> dimensions, double frames,
                           const LearningSettings& settings) {
  constexpr double kAdamStates = 2;  // of each parameter, in one buffer (Optimizer)
  const auto widest = static_cast<double>(std::ranges::max(dimensions)),
             hidden = static_cast<double>(settings.hidden);
  MemoryNeed need;
  double all = 0;
  for (const MachineSize& machine : machine_sizes(dimensions, settings)) {
    all += machine.parameters;
    if (is_greedy(settings))
      need.parameters =
          std::max(need.parameters, (machine.adam ? kAdamStates : 1) * machine.parameters);
  }
  if (is_greedy(settings)) need.frames = frames * std::max(widest, hidden);
  if (is_tuned(settings)) {
    need.parameters = kAdamStates * all;  // of the whole network in one (UnrolledNetwork)
    need.windows = std::max(frames_with_history(settings) * widest,
                            judged_frames(settings.fine_tuning) *
                                static_cast<double>(settings.fine_tuning.mean_field_steps) *
                                std::max(hidden, static_cast<double>(settings.mrbm_hidden)));
  }
  for (double* bytes : {&need.parameters, &need.windows, &need.frames}) *bytes *= sizeof(float);
  return need;
}

void check_memory(std::span<const std::size_t> dimensions, double frames,
                  const LearningSettings& settings, const DeviceInfo& device) {
  constexpr double kGigabyte = 1e9;
  const auto has = static_cast<double>(device.global_memory_bytes),
             in_one_buffer = static_cast<double>(device.largest_buffer_bytes);
  const MemoryNeed need = memory_need(dimensions, frames, settings);
  if (need.total() > has)
    throw ConfigError(fmt::format(
        "the training needs at least {:.3g} GB of memory, {} has {:.3g} GB: {}",
        need.total() / kGigabyte, device.name, has / kGigabyte, what_needs_less(need, settings)));
  const MemoryNeed buffers = largest_buffers(dimensions, frames, settings);
  if (buffers.largest() > in_one_buffer)
    throw ConfigError(fmt::format(
        "the training needs at least {:.3g} GB of memory in one buffer, {} takes {:.3g} GB: {}",
        buffers.largest() / kGigabyte, device.name, in_one_buffer / kGigabyte,
        what_needs_less(buffers, settings)));
}

void check_window(std::size_t longest, const LearningSettings& settings) {
  const std::size_t window = settings.layers * settings.order + settings.look_ahead + 1;
  if (window <= longest) return;
  throw ConfigError(fmt::format(
      "a window of {} is learnt from (`order` {} in each of `layers` {}, `look-ahead` {}, "
      "and its own), but the longest clip has {}; lower one of them, or give longer clips",
      counted(window, "frame"), settings.order, settings.layers, settings.look_ahead, longest));
}

}  // namespace mcdbn
