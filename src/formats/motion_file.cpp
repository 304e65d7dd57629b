#include "mcdbn/formats/motion_file.hpp"

#include <fmt/format.h>

#include "base/lower_extension.hpp"
#include "base/text_file.hpp"
#include "formats/asf_amc.hpp"
#include "formats/bvh_header.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"

namespace fs = std::filesystem;

namespace mcdbn {
namespace {

/// What macOS puts beside files on disks of others: `._NAME`, with no motion in it.
bool is_of_macos(const fs::path& path) {
  return path.filename().string().starts_with("._");
}

/// The ASF of an AMC: the one whose name begins the AMC's, before an underscore or as a whole; the
/// longest if there are more; else the only one in the folder.
fs::path skeleton_beside(const fs::path& amc) {
  const fs::path folder = amc.has_parent_path() ? amc.parent_path() : fs::path(".");
  const std::string name = amc.stem().string();
  fs::path best, last;
  std::size_t length = 0, count = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (lower_extension(entry.path()) != ".asf" || is_of_macos(entry.path())) continue;
    last = entry.path();
    ++count;
    const std::string own = entry.path().stem().string();
    const bool begins = name == own || name.starts_with(own + '_');
    if (!begins || own.size() < length) continue;
    best = entry.path();
    length = own.size();
  }
  if (best.empty() && count == 1) best = last;
  if (best.empty())
    throw InputError(fmt::format(
        "{}: its skeleton is missing; put the person's .asf beside it, named as the AMC begins",
        amc.string()));
  return best;
}

}  // namespace

bool is_motion_file(const fs::path& path) {
  const std::string extension = lower_extension(path);
  return (extension == ".bvh" || extension == ".amc") && !is_of_macos(path);
}

fs::path skeleton_file_of(const fs::path& path) {
  return lower_extension(path) == ".amc" ? skeleton_beside(path) : fs::path();
}

Motion parse_motion(std::string_view text, const fs::path& path,
                    std::vector<std::string>* warnings) {
  if (lower_extension(path) == ".asf")
    throw InputError(
        fmt::format("{}: is a skeleton; name the .amc files that hold its motion", path.string()));
  const fs::path skeleton = skeleton_file_of(path);
  if (skeleton.empty()) return parse_bvh(text, path.string(), warnings);
  return parse_asf_amc(read_text_file(skeleton), skeleton.string(), text, path.string(), warnings);
}

Skeleton read_skeleton(const fs::path& path) {
  const fs::path asf = skeleton_file_of(path);
  return asf.empty() ? read_bvh_skeleton(path)
                     : parse_asf_skeleton(read_text_file(asf), asf.string());
}

Motion read_motion(const fs::path& path, std::vector<std::string>* warnings) {
  return parse_motion(read_text_file(path), path, warnings);
}

}  // namespace mcdbn
