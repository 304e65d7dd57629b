#include "mcdbn/corpus/clip_list.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <iterator>
#include <map>
#include <sstream>
#include <system_error>

#include "base/shown.hpp"
#include "base/text_file.hpp"
#include "base/utf8.hpp"
#include "formats/toml_texts.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/corpus/clip.hpp"

namespace fs = std::filesystem;

namespace mcdbn {
namespace {

constexpr std::size_t kLongestName = 200;  ///< that a message repeats
constexpr const char* kExample = "give tables such as [[clip]] with file = \"walk/02_01.bvh\"";

ListedClip clip_from(const fs::path& path, const toml::table& table) {
  ListedClip clip{fs::path()};
  for (const auto& [key, node] : table) {
    const std::string text = text_of(path, key.str(), node, "a text");
    if (key == "file")
      clip.file = path.parent_path() / text;
    else if (key == "person")
      clip.person = text;
    else if (key == "action")
      clip.action = text;
    else
      fail_at(
          path, key.source(),
          fmt::format("no key {} is known; a clip has file, person and action", shown(key.str())));
  }
  if (clip.file.empty())
    fail_at(path, table.source(), fmt::format("a clip without file; {}", kExample));
  std::error_code error;  // of names that no file can have, too
  if (!fs::is_regular_file(clip.file, error))
    fail_at(path, table.source(),
            fmt::format("no such file: {}", printable_end(clip.file.string(), kLongestName)));
  return clip;
}

bool is_list(const fs::path& path) {
  return path.extension() == ".toml" && fs::is_regular_file(path);
}

std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << toml::value(text);
  return out.str();
}

/// What is said of a clip, by any list that names it.
/// @throws InputError where two lists contradict each other
void merge(const std::string& given, const char* what, const fs::path& file, std::string& known) {
  if (known.empty()) known = given;
  if (!given.empty() && given != known)
    throw InputError(fmt::format("{}: its {} is given as {} and as {}", file.string(), what,
                                 shown(known), shown(given)));
}

}  // namespace

std::vector<ListedClip> read_clip_list(const fs::path& path) {
  const toml::table content = read_toml(path, kExample);
  std::vector<ListedClip> clips;
  for (const auto& [key, node] : content) {
    const auto* tables = node.as_array();
    if (key != "clip" || tables == nullptr || !tables->is_array_of_tables())
      fail_at(path, key.source(), fmt::format("no list of clips; {}", kExample));
    for (const toml::node& table : *tables) clips.push_back(clip_from(path, *table.as_table()));
  }
  if (clips.empty()) throw InputError(fmt::format("{}:1: no clips; {}", path.string(), kExample));
  return clips;
}

std::vector<ListedClip> find_listed_clips(const std::vector<fs::path>& paths) {
  std::vector<ListedClip> clips;
  std::map<fs::path, std::size_t> seen;
  const auto add = [&](ListedClip clip) {
    const auto [place, is_new] = seen.try_emplace(fs::weakly_canonical(clip.file), clips.size());
    if (is_new) return clips.push_back(std::move(clip));
    ListedClip& known = clips[place->second];
    merge(clip.person, "person", clip.file, known.person);
    merge(clip.action, "action", clip.file, known.action);
  };
  for (const fs::path& path : paths)
    if (is_list(path))
      for (ListedClip& clip : read_clip_list(path)) add(std::move(clip));
    else
      for (fs::path& file : find_clips({path})) add(std::move(file));
  if (clips.empty()) find_clips({});
  return clips;
}

void write_clip_list(const fs::path& path, const std::vector<ListedClip>& clips) {
  std::string text =
      "# Clips for `mcdbn-cl train`. Files are relative to this folder; person and action may be\n"
      "# changed.\n";
  const fs::path folder = fs::absolute(path).parent_path();
  for (const ListedClip& clip : clips) {
    const fs::path file = fs::absolute(clip.file).lexically_normal();
    require_utf8(file.string(), clip.file.string() + ": its name");
    fmt::format_to(std::back_inserter(text), "\n[[clip]]\nfile = {}\n",
                   quoted(file.lexically_proximate(folder.lexically_normal()).generic_string()));
    if (!clip.person.empty())
      fmt::format_to(std::back_inserter(text), "person = {}\n", quoted(clip.person));
    if (!clip.action.empty())
      fmt::format_to(std::back_inserter(text), "action = {}\n", quoted(clip.action));
  }
  write_text_file(path, text);
}

}  // namespace mcdbn
