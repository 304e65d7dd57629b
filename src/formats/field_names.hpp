#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace mcdbn {

// How the files that people write call what they hold: a table's columns, JSON's keys. Names are
// compared in lower case and by letters and digits alone: `frameIdx` is `frame_idx`.

/// Of a joint's confidence; where a joint has several, the one that stands first here counts.
inline constexpr std::array kConfidenceNames{
    "visibility", "vis",         "visible", "score",    "confidence", "conf", "likelihood",
    "prob",       "probability", "v",       "presence", "c",          "s",    "p"};
bool is_confidence_name(std::string_view name);
/// Of the list of all joints' confidences: `confidences`, `keypoint_scores`, `conf`.
bool is_confidence_list_name(std::string_view name);

/// Of a frame's number.
bool is_frame_name(std::string_view name);

struct TimeName {
  std::optional<double> unit_s;  ///< none: the name does not give it
};
/// Of a frame's time; none: it is no such name.
std::optional<TimeName> time_name(std::string_view name);

/// Of a film's frames a second, its width and height, and the list of both, in this order.
bool is_rate_name(std::string_view name);
bool is_width_name(std::string_view name);
bool is_height_name(std::string_view name);
bool is_size_name(std::string_view name);

}  // namespace mcdbn
