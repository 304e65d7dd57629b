#include "mcdbn/device/tuning.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/user_cache.hpp"
#include "device/tuning_fields.hpp"
#include "mcdbn/device/device.hpp"

namespace mcdbn {
namespace {

constexpr const char* kKind = "tuning";
/// Work-items that a group of CLBlast's products may have.
constexpr std::size_t kClblastGroup = 256;

std::string key_of(const DeviceInfo& info) {
  return "5|" + info.platform_name + '|' + info.name + '|' + info.driver_version + '|' +
         std::to_string(info.compute_units);
}

bool is_one_of(int value, std::initializer_list<int> values) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

bool is_in(int value, int least, int most) {
  return value >= least && value <= most;
}

bool makes_sense(const Tuning& tuning) {
  return is_one_of(tuning.vector_width, {1, 4, 8, 16}) && tuning.largest_rows >= 1 &&
         tuning.largest_rows <= 32 && tuning.accumulators >= 1 && tuning.accumulators <= 64 &&
         tuning.group >= 1 && tuning.group <= 256 && is_one_of(tuning.update_rows, {4, 8, 16}) &&
         is_in(tuning.update_columns, 1, 4) && is_in(tuning.product_columns, 1, 4) &&
         is_in(tuning.transposed_columns, 1, 4) && tuning.product_rows >= 1 &&
         tuning.product_rows <= 16 && is_one_of(tuning.transposed_rows, {4, 8, 16}) &&
         tuning.summed_rows >= 0 && is_in(tuning.unroll, 1, 32) && tuning.clblast_from >= 0;
}

}  // namespace

Tuning limited(Tuning tuning, const DeviceInfo& info) {
  const std::size_t most = std::min(info.largest_group, info.largest_group_sides[0]);
  if (static_cast<std::size_t>(tuning.group) > most)
    tuning.group = static_cast<int>(std::max<std::size_t>(most, 1));
  if (most < kClblastGroup) tuning.clblast_from = 0;
  return tuning;
}

std::vector<Tuning> tuning_candidates(const DeviceInfo& info, const Tuning& from) {
  std::vector<Tuning> candidates{from};
  const auto vary = [&](auto Tuning::*parameter, std::initializer_list<int> values) {
    for (const int value : values) {
      Tuning tuning = from;
      tuning.*parameter = value;
      tuning = limited(tuning, info);
      if (std::ranges::count(candidates, tuning) == 0) candidates.push_back(tuning);
    }
  };
  if (info.is_gpu) {
    vary(&Tuning::vector_width, {1, 4});
    vary(&Tuning::largest_rows, {2, 4, 8});
    vary(&Tuning::group, {64, 128, 256});
    vary(&Tuning::unroll, {1, 4, 8, 16});
    vary(&Tuning::update_rows, {4, 8});
  } else {
    vary(&Tuning::vector_width, {8, 16, 4});
    vary(&Tuning::largest_rows, {8, 10, 14});
    vary(&Tuning::accumulators, {12, 24, 28});
    vary(&Tuning::update_rows, {4, 8, 16});
    vary(&Tuning::update_columns, {1, 2, 3, 4});
    vary(&Tuning::product_columns, {1, 2});
  }
  return candidates;
}

std::optional<Tuning> load_tuning(const DeviceInfo& info) {
  const auto entry = read_cache_entry(kKind, key_of(info));
  if (!entry) return std::nullopt;
  try {
    const auto json = nlohmann::json::parse(*entry);
    Tuning tuning;
    for (const TuningField& field : kTuningFields)
      tuning.*field.value = json.at(std::string(field.name));
    tuning.clblast_from = json.at("clblast_from");
    if (makes_sense(tuning)) return tuning;
  } catch (const nlohmann::json::exception&) {
    // another version's: as if there were none
  }
  return std::nullopt;
}

bool store_tuning(const DeviceInfo& info, const Tuning& tuning) {
  nlohmann::json json = {{"clblast_from", tuning.clblast_from}};
  for (const TuningField& field : kTuningFields)
    json[std::string(field.name)] = tuning.*field.value;
  return write_cache_entry(kKind, key_of(info), json.dump());
}

}  // namespace mcdbn
