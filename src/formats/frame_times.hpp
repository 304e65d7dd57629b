#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/json_text.hpp"
#include "formats/seen_people.hpp"

namespace mcdbn {

/// The frames of which a file's entries are, by their times: 0 is the first, and from one time to
/// the next there are as many as the usual step goes into theirs, one at least.
/// @param times [entries] in any unit and order; entries of one time are of one frame
/// @return [entries]; empty if one has no time (NaN)
std::vector<long long> frames_by_times(const std::vector<double>& times);

/// Whether times rise from entry to entry; none is NaN.
/// @param people [entries] whose they are: those of each person rise. None: all are of one
bool do_rise(const std::vector<double>& times, const std::vector<std::string>& people = {});

/// Sets the people's times; if these do not rise, there is a notice instead.
/// @param name of the column or key, which may give the unit. Else it is the largest of s, ms, us
/// and ns in which the median of the steps is at most a second
/// @param numbers [entries] of their frames
/// @param times [entries] as the file gives them; NaN: none
void take_times(SeenPeople& people, std::string_view name, const std::vector<long long>& numbers,
                const std::vector<double>& times);

/// Whether an entry of a JSON list gives its frame's number or time.
bool gives_frame(const JsonPlace& entry);

/// The numbers of a JSON list's frames: as they give them, else by their times, else one after the
/// other. Their times become the people's.
/// @return [frames]  @throws InputError
std::vector<long long> numbers_of_frames(const JsonPlace& list, SeenPeople& people);

}  // namespace mcdbn
