// SLEAP: the analysis CSV, a row for each instance of each frame: track, frame_idx, instance.score,
// and for each node NODE.score, NODE.x, NODE.y. A node that was not found has empty x and y.
// Facts: SLEAP's docs, "Export data for analysis".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/shown.hpp"
#include "base/text_file.hpp"
#include "formats/csv_table.hpp"
#include "formats/csv_text.hpp"
#include "formats/joint_naming.hpp"
#include "formats/track_formats.hpp"

namespace mcdbn {
namespace {

const char* const kName = "sleap";
const std::string kFrame = "frame_idx", kTrack = "track", kInstance = "instance";

bool recognises(const TrackSource& source) {
  if (source.is_folder()) return false;
  const CsvTable table(source.text(), source.name(), 1);
  if (table.lines().empty()) return false;
  const auto& header = table.lines().front().cells;
  return std::ranges::find(header, kFrame) != header.end() &&
         std::ranges::any_of(header, [](std::string_view name) { return name.ends_with(".x"); });
}

/// Where a node's numbers stand.
struct Node {
  std::optional<std::size_t> x, y, score;
};

class SleapReader {
 public:
  explicit SleapReader(const TrackSource& source) : table_(source.text(), source.name()) {}

  SeenPeople read() {
    read_header();
    people_.in_pixels = true;
    for (std::size_t i = 1; i < table_.lines().size(); ++i) read_instance(table_.lines()[i]);
    name_joints(people_, names_);
    return std::move(people_);
  }

 private:
  void read_header() {
    const CsvTable::Line& header = table_.header();
    for (std::size_t k = 0; k < header.cells.size(); ++k) {
      const std::string_view name = header.cells[k];
      if (name == kFrame) frame_ = k;
      if (name == kTrack) track_ = k;
      const auto dot = name.rfind('.');
      if (dot == std::string_view::npos || name.substr(0, dot) == kInstance) continue;
      Node& node = node_of(name.substr(0, dot));
      const std::string_view quantity = name.substr(dot + 1);
      if (quantity == "x") node.x = k;
      if (quantity == "y") node.y = k;
      if (quantity == "score") node.score = k;
    }
    if (!frame_) table_.fail(header, fmt::format("no column {}", kFrame));
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (!nodes_[i].x || !nodes_[i].y)
        table_.fail(header, fmt::format("node {} needs both columns, .x and .y", shown(names_[i])));
    if (nodes_.empty()) table_.fail(header, "no nodes: columns NODE.x and NODE.y");
  }

  Node& node_of(std::string_view name) {
    const std::size_t index = index_of(names_, name);
    nodes_.resize(names_.size());
    return nodes_[index];
  }

  void read_instance(const CsvTable::Line& line) {
    table_.require_cells(line, table_.header().cells.size());
    const double frame = table_.number_in(line, *frame_);
    if (!(std::abs(frame) < 1e15) || frame != std::floor(frame))
      table_.fail(line, fmt::format("{} is no number of a frame", shown(line.cells[*frame_])));
    SeenPerson person;
    for (const Node& node : nodes_) {
      person.x_px.push_back(table_.number_in(line, *node.x));
      person.y_px.push_back(table_.number_in(line, *node.y));
      // Instances that a user labelled have no scores.
      person.confidence.push_back(table_.confidence_in(line, node.score));
    }
    mark_missing(person);
    if (track_ && !line.cells[*track_].empty())
      person.id = people_.id_of_track(line.cells[*track_]);
    people_.frames[static_cast<long long>(frame)].push_back(std::move(person));
  }

  CsvTable table_;
  std::optional<std::size_t> frame_, track_;
  std::vector<std::string> names_;
  std::vector<Node> nodes_;
  SeenPeople people_;
};

SeenPeople read(const TrackSource& source) {
  return SleapReader(source).read();
}

void write(const std::filesystem::path& path, const Track2d& track) {
  std::string text = "track,frame_idx,instance.score";
  for (const std::string& name : track.joint_names) {
    require_csv_name(name);
    text += fmt::format(",{0}.score,{0}.x,{0}.y", name);
  }
  text += '\n';
  for (int frame = 0; frame < track.frames(); ++frame) {
    text += fmt::format("track_0,{},1", frame);
    for (int joint = 0; joint < track.joint_count(); ++joint)
      text += track.confidence(frame, joint) > 0
                  ? fmt::format(",{},{},{}", track.confidence(frame, joint),
                                track.x_px(frame, joint), track.y_px(frame, joint))
                  : std::string(",0,,");
    text += '\n';
  }
  write_text_file(path, text);
}

}  // namespace

TrackFormat track_sleap_format() {
  return {kName, "SLEAP's analysis CSV, a row for each instance of each frame",
          {},    recognises,
          read,  write};
}

}  // namespace mcdbn
