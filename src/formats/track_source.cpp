#include "formats/track_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "base/text_file.hpp"
#include "formats/frame_numbers.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

namespace fs = std::filesystem;

namespace {

/// macOS puts `._NAME`, which is no JSON, beside files on disks of others.
bool is_hidden(const fs::path& file) {
  return file.filename().string().starts_with('.');
}

}  // namespace

TrackSource::TrackSource(fs::path path) : path_(std::move(path)) {
  std::error_code error;
  if (!fs::exists(path_, error))
    throw InputError(fmt::format("{}: no such file or folder", path_.string()));
  is_folder_ = fs::is_directory(path_, error);
  if (!is_folder_) {
    json_files_ = {path_};
    return;
  }
  for (fs::directory_iterator entry(path_, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().extension() == ".json" && !is_hidden(entry->path()))
      json_files_.push_back(entry->path());
  if (error) throw InputError(fmt::format("{}: the folder cannot be read", path_.string()));
  std::ranges::sort(json_files_);
}

TrackSource::TrackSource(std::string text, std::string name, int lines_before)
    : path_(std::move(name)),
      lines_before_(lines_before),
      json_files_({path_}),
      text_(std::move(text)) {}

const std::string& TrackSource::text() const {
  if (!text_) text_ = read_text_file(path_);
  return *text_;
}

char TrackSource::first_letter() const {
  if (is_folder_) return '\0';
  std::string_view start = text();
  if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
  const auto found = start.find_first_not_of(" \t\r\n");
  return found == std::string_view::npos ? '\0' : start[found];
}

std::optional<JsonPlace> TrackSource::json_if_any() const {
  if (first_letter() != '{' && first_letter() != '[') return {};
  try {
    return json();
  } catch (const InputError&) {
    return {};
  }
}

JsonPlace TrackSource::json() const {
  if (!json_) json_ = parse_json(text(), name(), &is_json_lines_);
  return JsonPlace(*json_, name());
}

bool TrackSource::is_json_lines() const {
  (void)json();
  return is_json_lines_;
}

std::optional<JsonPlace> TrackSource::first_json_if_any() const {
  if (!is_folder_) return json_if_any();
  if (first_json_) return JsonPlace(*first_json_, name());
  try {
    const auto numbers = numbers_of_files(json_files_);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!numbers[i]) continue;
      first_json_ = json_of(json_files_[i]);
      if (!first_json_->empty()) return JsonPlace(*first_json_, name());
    }
  } catch (const InputError&) {
    first_json_.reset();
    return {};
  }
  return first_json_ ? std::optional(JsonPlace(*first_json_, name())) : std::nullopt;
}

nlohmann::json TrackSource::json_of(const fs::path& file) const {
  return parse_json(read_text_file(file), file.string());
}

}  // namespace mcdbn
