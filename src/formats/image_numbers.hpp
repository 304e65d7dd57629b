#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "formats/json_text.hpp"

namespace mcdbn {

/// Which frames the images of one clip are: numbers, or names with the numbers of frames in them
/// ("vid3/frame_000012_cam2.jpg", frame_numbers of all of them).
class ImageNumbers {
 public:
  explicit ImageNumbers(const std::vector<std::string>& names);
  /// The names under a key of entries; entries with numbers there need none.
  ImageNumbers(const std::vector<JsonPlace>& entries, const std::string& key);

  /// @param place for messages  @throws InputError if the name has no number
  long long of(const JsonPlace& place, const std::string& name) const;
  /// @throws InputError if this is neither a number nor a name with one
  long long of(const JsonPlace& id) const;

 private:
  std::map<std::string, std::optional<long long>> numbers_;
};

}  // namespace mcdbn
