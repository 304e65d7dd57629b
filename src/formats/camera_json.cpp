#include "formats/camera_json.hpp"

#include <fmt/format.h>

#include "base/parsed_json.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

void add_numbers(const nlohmann::json& entry, const std::string& where,
                 std::vector<double>& numbers) {
  if (entry.is_array()) {
    for (const nlohmann::json& inner : entry) add_numbers(inner, where, numbers);
  } else if (entry.is_number()) {
    numbers.push_back(entry.get<double>());
  } else {
    throw InputError(where + " holds something that is not a number; correct it");
  }
}

}  // namespace

nlohmann::json camera_json(const CameraSource& source) {
  nlohmann::json parsed = parsed_json(source.text);
  return parsed.is_discarded() ? nlohmann::json() : parsed;
}

std::vector<double> json_numbers(const nlohmann::json& object, const std::string& key,
                                 std::size_t count, const std::string& path) {
  const std::string where = path + "." + key + ":";
  if (!object.is_object() || !object.contains(key)) throw InputError(where + " is missing; add it");
  std::vector<double> numbers;
  add_numbers(object.at(key), where, numbers);
  if (numbers.size() != count)
    throw InputError(fmt::format("{} has {} numbers, expected {}", where, numbers.size(), count));
  return numbers;
}

}  // namespace mcdbn
