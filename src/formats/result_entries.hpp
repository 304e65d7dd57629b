#pragma once

#include <optional>
#include <vector>

#include "formats/json_text.hpp"

namespace mcdbn {

/// The entries of a list of results, each of a person in an image. Lists in it, of the people of an
/// image each, as JSON lines hold them, are taken apart; null is left out.
/// @throws InputError if this is no list
std::vector<JsonPlace> result_entries(const JsonPlace& list);

/// The first of them; none: there are none, or this is no list.
std::optional<JsonPlace> first_result_entry(const JsonPlace& list);

}  // namespace mcdbn
