#include "formats/result_entries.hpp"

#include <algorithm>
#include <iterator>

namespace mcdbn {

std::vector<JsonPlace> result_entries(const JsonPlace& list) {
  std::vector<JsonPlace> entries;
  for (const JsonPlace& entry : list.list()) {
    if (entry.is_list())
      std::ranges::copy(entry.list(), std::back_inserter(entries));
    else if (!entry.value().is_null())
      entries.push_back(entry);
  }
  return entries;
}

std::optional<JsonPlace> first_result_entry(const JsonPlace& list) {
  for (std::size_t i = 0; list.is_list() && i < list.size(); ++i) {
    const JsonPlace entry = list.at(i);
    if (entry.is_list() && entry.size() > 0) return entry.at(0);
    if (!entry.is_list() && !entry.value().is_null()) return entry;
  }
  return {};
}

}  // namespace mcdbn
