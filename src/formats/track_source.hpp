#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/json_text.hpp"

namespace mcdbn {

/// The file, or the folder of files, that a track is read from. What was read once is kept, so that
/// all formats may look at it.
class TrackSource {
 public:
  /// @throws InputError if there is no such file or folder
  explicit TrackSource(std::filesystem::path path);
  /// Text that stands in no file. @param name for messages  @param lines_before it, which they
  /// count
  TrackSource(std::string text, std::string name, int lines_before = 0);

  const std::filesystem::path& path() const { return path_; }
  std::string name() const { return path_.string(); }
  int lines_before() const { return lines_before_; }
  bool is_folder() const { return is_folder_; }
  /// The .json files of a folder, sorted by name; of a file it alone.
  const std::vector<std::filesystem::path>& json_files() const { return json_files_; }

  /// The file's bytes. @throws InputError also if it is a folder
  const std::string& text() const;
  /// The first letter of the text that is no space.
  char first_letter() const;
  /// The file's JSON if it is one that can be parsed; none: a folder, or other content.
  std::optional<JsonPlace> json_if_any() const;
  /// @throws InputError `file:line: what`
  JsonPlace json() const;
  /// Whether that JSON is a list of lines, a frame each. @throws as json()
  bool is_json_lines() const;
  /// JSON of the file, or of a folder's first frame that is not an empty list (no person found).
  std::optional<JsonPlace> first_json_if_any() const;
  /// JSON of one of json_files(); it is not kept.
  nlohmann::json json_of(const std::filesystem::path& file) const;

 private:
  std::filesystem::path path_;
  bool is_folder_ = false;
  int lines_before_ = 0;
  std::vector<std::filesystem::path> json_files_;
  mutable std::optional<std::string> text_;
  mutable std::optional<nlohmann::json> json_, first_json_;
  mutable bool is_json_lines_ = false;
};

}  // namespace mcdbn
