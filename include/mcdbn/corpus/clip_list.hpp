#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mcdbn {

/// A clip's file, and who does what in it where that is given.
struct ListedClip {
  // NOLINTNEXTLINE(google-explicit-constructor): a file is a clip without either.
  ListedClip(std::filesystem::path path, std::string who = {}, std::string what = {})
      : file(std::move(path)), person(std::move(who)), action(std::move(what)) {}

  std::filesystem::path file;
  std::string person, action;
};

/// Clips that a command line means: files and folders as find_clips takes them, and lists. Each
/// clip counts once; its person and action are those of any list that names it.
/// @throws InputError as find_clips and read_clip_list do, or if two lists contradict each other
std::vector<ListedClip> find_listed_clips(const std::vector<std::filesystem::path>& paths);

/// A list of clips, TOML: a table `[[clip]]` for each with `file`, relative to the list's folder or
/// absolute, and if wanted `person` and `action`.
/// @throws InputError `file:line: what`
std::vector<ListedClip> read_clip_list(const std::filesystem::path& path);

/// Writes such a list, files relative to its folder. @throws InputError if it cannot be written
void write_clip_list(const std::filesystem::path& path, const std::vector<ListedClip>& clips);

}  // namespace mcdbn
