#pragma once

#include <optional>
#include <string>
#include <vector>

namespace mcdbn {

/// The frame numbers in the names of the files of one clip, which hold other numbers, too
/// ("cam01.0007_keypoints.json"): the last group of digits that is different in each.
/// @return [names]; none where a name has no such group
std::vector<std::optional<long long>> frame_numbers(const std::vector<std::string>& names);

}  // namespace mcdbn
