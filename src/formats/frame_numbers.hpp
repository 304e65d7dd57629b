#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mcdbn {

/// The frame numbers in the names of the files of one clip, which hold other numbers, too
/// ("cam01.0007_keypoints.json"): the last group of digits that is different in each.
/// @return [names]; none where a name has no such group
std::vector<std::optional<long long>> frame_numbers(const std::vector<std::string>& names);

/// Of the files of a folder: the frame numbers in their names, or, where no name has one, their
/// order.
/// @return [files]; none for a file that is no frame: its name has no number, those of others do
std::vector<std::optional<long long>> numbers_of_files(
    const std::vector<std::filesystem::path>& files);

}  // namespace mcdbn
