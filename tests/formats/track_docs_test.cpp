// docs/formats.md lists the formats and joint sets that there are.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <map>
#include <sstream>
#include <string>

#include "base/text_file.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;

namespace {

/// Of each row `| `name` | … | joints |` of the table of tracks: its last cell.
std::map<std::string, std::string> rows_of_tracks() {
  std::istringstream page(
      read_text_file(std::filesystem::path(MCDBN_SOURCE_DIR) / "docs/formats.md"));
  std::map<std::string, std::string> rows;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) inside = line == "## 2D tracks";
    if (!inside || !line.starts_with("| `")) continue;
    const auto end = line.find('`', 3), last = line.rfind('|', line.size() - 2);
    rows[line.substr(3, end - 3)] = line.substr(last);
  }
  return rows;
}

}  // namespace

TEST_CASE("the page of formats has a row for each track format, with its joint sets") {
  auto rows = rows_of_tracks();
  for (const TrackFormat& format : track_formats()) {
    CAPTURE(format.name);
    REQUIRE(rows.contains(format.name));
    std::string listed;
    for (const std::string& set : format.joint_sets)
      listed += fmt::format("{}{}", listed.empty() ? "" : ", ", set);
    if (listed.empty()) listed = "as named";
    CHECK(rows[format.name].find(listed) != std::string::npos);
    rows.erase(format.name);
  }
  CHECK(rows.empty());
}
