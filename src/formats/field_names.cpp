#include "formats/field_names.hpp"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <utility>

namespace mcdbn {
namespace {

/// In lower case, its letters and digits alone.
std::string bare(std::string_view name) {
  std::string result;
  for (const unsigned char letter : name)
    if (std::isalnum(letter) != 0) result += static_cast<char>(std::tolower(letter));
  return result;
}

bool is_one_of(std::string_view word, std::initializer_list<const char*> known) {
  return std::ranges::find(known, word) != known.end();
}

/// Whether a name is `of_film`, alone or behind a word for the picture.
bool is_of_picture(std::string_view name, std::string_view of_film, bool alone) {
  std::string word = bare(name);
  if (word.ends_with("px")) word.resize(word.size() - 2);
  if (!word.ends_with(of_film)) return false;
  word.resize(word.size() - of_film.size());
  return (alone && word.empty()) || is_one_of(word, {"image", "img", "video", "frame", "canvas"});
}

}  // namespace

bool is_confidence_name(std::string_view name) {
  return std::ranges::find(kConfidenceNames, bare(name)) != kConfidenceNames.end();
}

bool is_confidence_list_name(std::string_view name) {
  const std::string word = bare(name);
  return std::ranges::any_of(
      std::initializer_list<std::string_view>{"", "keypoint", "keypoints", "landmark", "landmarks",
                                              "joint", "joints", "pose", "kpt", "kpts"},
      [&](std::string_view of) {
        if (!word.starts_with(of)) return false;
        const std::string_view rest = std::string_view(word).substr(of.size());
        if (rest.size() < 2 && !of.empty()) return false;  // `joints` is no `s` of joints
        return is_confidence_name(rest) || is_one_of(rest, {"visibilities", "probabilities"}) ||
               (rest.ends_with('s') && is_confidence_name(rest.substr(0, rest.size() - 1)));
      });
}

bool is_frame_name(std::string_view name) {
  return is_one_of(bare(name), {"frame", "frameid", "frameidx", "frameindex", "framenumber",
                                "framenum", "frameno", "frames"});
}

std::optional<TimeName> time_name(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, double>, 8> kUnits_s{{{"s", 1},
                                                                         {"sec", 1},
                                                                         {"seconds", 1},
                                                                         {"ms", 1e-3},
                                                                         {"msec", 1e-3},
                                                                         {"milliseconds", 1e-3},
                                                                         {"us", 1e-6},
                                                                         {"ns", 1e-9}}};
  const std::string word = bare(name);
  for (const std::string_view time : {"timestamp", "time", "ts"}) {
    if (!word.starts_with(time)) continue;
    const std::string_view rest = std::string_view(word).substr(time.size());
    if (rest.empty()) return TimeName{};
    for (const auto& [unit, unit_s] : kUnits_s)
      if (rest == unit) return TimeName{unit_s};
  }
  return {};
}

bool is_rate_name(std::string_view name) {
  return is_one_of(bare(name), {"fps", "framerate", "videofps"});
}

bool is_width_name(std::string_view name) {
  return is_of_picture(name, "width", true);
}

bool is_height_name(std::string_view name) {
  return is_of_picture(name, "height", true);
}

bool is_size_name(std::string_view name) {
  return is_of_picture(name, "size", false);
}

}  // namespace mcdbn
