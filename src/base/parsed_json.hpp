#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace mcdbn {

/// Whether lists and objects stand in each other more than `deepest` times, outside of strings.
bool nests_deeper(std::string_view text, int deepest);

/// Far above what any format needs.
inline constexpr int kDeepestJson = 64;

/// JSON out of a file of others. What reads or copies a value calls itself for all that is nested
/// in it, so what nests deeper than any of our files is none.
/// @return discarded (`is_discarded()`) where it is none
template <typename Json = nlohmann::json>
Json parsed_json(std::string_view text) {
  if (nests_deeper(text, kDeepestJson)) return Json::value_t::discarded;
  return Json::parse(text, nullptr, false);
}

}  // namespace mcdbn
