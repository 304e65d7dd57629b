#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mcdbn {

/// The frame numbers in the names of the files of one clip, which hold other numbers, too
/// ("cam01.0007_keypoints.json"): the last group of digits that is different in each. Where it is
/// the fraction behind a second ("1699999999.967", "143005_120") they are the order of these times.
/// @return [names]; none where a name has no such group
std::vector<std::optional<long long>> frame_numbers(const std::vector<std::string>& names);

/// Whether these numbers are the order of times.
bool are_times(const std::vector<std::string>& names);

/// Frame numbers of a folder's files: those in their names, or, where no name has one, their order.
/// @param notices gets what was adapted, if not null
/// @return [files]; none for a file that is no frame: its name has no number, those of others do
std::vector<std::optional<long long>> numbers_of_files(
    const std::vector<std::filesystem::path>& files, std::vector<std::string>* notices = nullptr);

}  // namespace mcdbn
