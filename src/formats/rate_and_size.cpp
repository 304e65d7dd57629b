#include "formats/rate_and_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "formats/csv_text.hpp"
#include "formats/field_names.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/motion/frame_rate.hpp"

namespace mcdbn {
namespace {

using NameTest = bool (*)(std::string_view name);

constexpr std::array kFactsKeys{"metadata", "meta",  "video_info", "videoInfo",
                                "info",     "video", "image_size", "imageSize"};
constexpr std::array kFramesKeys{"frames", "instance_info", "predictions"};

std::optional<double> number_called(const JsonPlace& place, NameTest is_name) {
  if (!place.is_object()) return {};
  for (const auto& [key, value] : place.value().items())
    if (value.is_number() && is_name(key)) return value.get<double>();
  return {};
}

std::optional<double> rate_in(const JsonPlace& place) {
  return number_called(place, is_rate_name);
}

/// One side of the image; @param at where it stands in a list of both
std::optional<double> side_in(const JsonPlace& place, NameTest is_side, std::size_t at) {
  if (const auto side = number_called(place, is_side)) return side;
  if (!place.is_object()) return {};
  for (const auto& [key, value] : place.value().items())
    if (value.is_array() && value.size() == 2 && value[at].is_number() && is_size_name(key))
      return value[at].get<double>();
  return {};
}

std::optional<double> width_in(const JsonPlace& place) {
  return side_in(place, is_width_name, 0);
}

std::optional<double> height_in(const JsonPlace& place) {
  return side_in(place, is_height_name, 1);
}

using Fact = std::optional<double> (*)(const JsonPlace& place);

/// What the content, or an object of facts in it, gives.
std::optional<double> beside_frames(const JsonPlace& content, Fact fact, const Range& range) {
  if (!content.is_object()) return {};
  std::vector<JsonPlace> places{content};
  for (const char* key : kFactsKeys)
    if (content.has(key)) places.push_back(content[key]);
  for (const JsonPlace& place : places)
    if (const auto found = fact(place)) {
      if (!range.contains(*found))
        place.fail(
            fmt::format("a rate or an image's size of {}; it must be {}", *found, range.text()));
      return found;
    }
  return {};
}

/// The value that all have who have one, two at least. The width of a box and the speed of a
/// detector, which may be called the same, change from frame to frame.
class CommonValue {
 public:
  void add(double value) {
    if (count_++ == 0) value_ = value;
    is_one_ = is_one_ && value == value_;
  }
  std::optional<double> in(const Range& range) const {
    return count_ > 1 && is_one_ && range.contains(value_) ? std::optional(value_) : std::nullopt;
  }

 private:
  double value_ = 0;
  int count_ = 0;
  bool is_one_ = true;
};

/// The list of frames; of other content none.
std::vector<JsonPlace> frames_in(const JsonPlace& content) {
  if (content.is_list()) return content.list();
  for (const char* key : kFramesKeys)
    if (content.has(key) && content[key].is_list()) return content[key].list();
  return {};
}

CommonValue in_frames(const std::vector<JsonPlace>& frames, Fact fact) {
  CommonValue common;
  for (const JsonPlace& frame : frames)
    if (const auto found = fact(frame)) common.add(*found);
  return common;
}

CommonValue in_rows(const CsvTable& table, NameTest is_name) {
  CommonValue common;
  const auto& names = table.header().cells;
  const auto column =
      static_cast<std::size_t>(std::ranges::find_if(names, is_name) - names.begin());
  if (column == names.size()) return common;
  for (std::size_t i = 1; i < table.lines().size(); ++i) {
    const auto& cells = table.lines()[i].cells;
    if (column < cells.size() && !cells[column].empty())
      common.add(number(cells[column]).value_or(0));
  }
  return common;
}

void set_size(SeenPeople& people, std::optional<double> width_px, std::optional<double> height_px) {
  if (width_px && height_px)
    people.image_size = ImageSize{static_cast<int>(*width_px), static_cast<int>(*height_px)};
}

}  // namespace

void take_rate_and_size(const JsonPlace& content, SeenPeople& people) {
  people.fps = beside_frames(content, rate_in, kFrameRate_hz);
  auto width_px = beside_frames(content, width_in, Camera::kImage_px);
  auto height_px = beside_frames(content, height_in, Camera::kImage_px);
  const std::vector<JsonPlace> frames = frames_in(content);
  if (!people.fps) people.fps = in_frames(frames, rate_in).in(kFrameRate_hz);
  if (!width_px || !height_px) {
    width_px = in_frames(frames, width_in).in(Camera::kImage_px);
    height_px = in_frames(frames, height_in).in(Camera::kImage_px);
  }
  set_size(people, width_px, height_px);
}

void take_rate_and_size(const CsvTable& table, SeenPeople& people) {
  people.fps = in_rows(table, is_rate_name).in(kFrameRate_hz);
  set_size(people, in_rows(table, is_width_name).in(Camera::kImage_px),
           in_rows(table, is_height_name).in(Camera::kImage_px));
}

}  // namespace mcdbn
