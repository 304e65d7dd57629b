// CSV with columns for each landmark: L0_x, L0_y, L0_z, L0_visibility; x1, y1, z1, v1; NOSE_x …
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>

#include "base/shown.hpp"
#include "formats/csv_table.hpp"
#include "formats/landmarks.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

enum class Quantity { x, y, depth, confidence };

std::optional<Quantity> quantity_of(std::string_view word) {
  const std::string name = lower(word);
  if (name == "x") return Quantity::x;
  if (name == "y") return Quantity::y;
  if (name == "z") return Quantity::depth;
  for (const char* known : {"visibility", "vis", "v", "confidence", "conf", "c", "score", "s",
                            "likelihood", "presence", "p"})
    if (name == known) return Quantity::confidence;
  return {};
}

struct Column {
  std::string joint;
  Quantity quantity;
};

bool separates(char letter) {
  return letter == '_' || letter == '.' || letter == '-' || letter == ' ' || letter == ':';
}

/// NAME_x, x_NAME or x12.
std::optional<Column> column_of(std::string_view name) {
  const auto last = std::find_if(name.rbegin(), name.rend(), separates).base() - name.begin();
  if (last > 1)
    if (const auto quantity = quantity_of(name.substr(static_cast<std::size_t>(last))))
      return Column{std::string(name.substr(0, static_cast<std::size_t>(last) - 1)), *quantity};
  const auto first = std::ranges::find_if(name, separates) - name.begin();
  if (static_cast<std::size_t>(first) + 1 < name.size())
    if (const auto quantity = quantity_of(name.substr(0, static_cast<std::size_t>(first))))
      return Column{std::string(name.substr(static_cast<std::size_t>(first) + 1)), *quantity};
  const auto digit = name.find_first_of("0123456789");
  if (digit == std::string_view::npos ||
      name.find_first_not_of("0123456789", digit) != std::string_view::npos)
    return {};
  if (const auto quantity = quantity_of(name.substr(0, digit)))
    return Column{std::string(name.substr(digit)), *quantity};
  return {};
}

bool is_frame_column(std::string_view name) {
  const std::string known = lower(name);
  for (const char* frame :
       {"frame", "frame_idx", "frame_id", "frame_number", "frame_no", "frame_index", "frames"})
    if (known == frame) return true;
  return false;
}

struct JointColumns {
  std::optional<std::size_t> x, y, confidence;
};

class ColumnsReader {
 public:
  ColumnsReader(std::string_view text, const std::string& file) : table_(text, file), file_(file) {
    if (table_.lines().empty()) throw InputError(fmt::format("{}: empty", file));
  }

  SeenPeople read() {
    read_header();
    for (std::size_t i = 1; i < table_.lines().size(); ++i) read_frame(table_.lines()[i]);
    name_landmarks(people_, file_, names_);
    return std::move(people_);
  }

 private:
  void read_header() {
    const CsvTable::Line& header = table_.lines().front();
    for (std::size_t k = 0; k < header.cells.size(); ++k) {
      if (is_frame_column(header.cells[k])) frame_ = k;
      const auto column = column_of(header.cells[k]);
      if (!column || column->quantity == Quantity::depth) continue;
      JointColumns& joint = joint_of(column->joint);
      auto& place = column->quantity == Quantity::x   ? joint.x
                    : column->quantity == Quantity::y ? joint.y
                                                      : joint.confidence;
      // The first of several confidences: visibility before presence.
      if (!place) place = k;
    }
    drop_incomplete();
    if (joints_.empty()) table_.fail(header, "no landmarks: columns NAME_x and NAME_y");
  }

  JointColumns& joint_of(const std::string& name) {
    const auto found = std::ranges::find(names_, name);
    const auto index = static_cast<std::size_t>(found - names_.begin());
    if (found == names_.end()) {
      names_.push_back(name);
      joints_.emplace_back();
    }
    return joints_[index];
  }

  /// Columns that only look like a landmark's: a score of the whole body.
  void drop_incomplete() {
    for (std::size_t i = joints_.size(); i-- > 0;) {
      if (joints_[i].x && joints_[i].y) continue;
      joints_.erase(joints_.begin() + static_cast<std::ptrdiff_t>(i));
      names_.erase(names_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  void read_frame(const CsvTable::Line& line) {
    table_.require_cells(line, table_.lines().front().cells.size());
    SeenPerson person;
    for (const JointColumns& joint : joints_) {
      person.x_px.push_back(table_.number_in(line, *joint.x));
      person.y_px.push_back(table_.number_in(line, *joint.y));
      person.confidence.push_back(table_.confidence_in(line, joint.confidence));
    }
    mark_missing(person);
    auto number = static_cast<long long>(people_.frames.size());
    if (frame_) {
      const double given = table_.number_in(line, *frame_);
      if (!(std::abs(given) < 1e15) || given != std::floor(given))
        table_.fail(line, fmt::format("{} is no number of a frame", shown(line.cells[*frame_])));
      number = static_cast<long long>(given);
    }
    people_.frames[number].push_back(std::move(person));
  }

  CsvTable table_;
  std::string file_;
  std::optional<std::size_t> frame_;
  std::vector<std::string> names_;
  std::vector<JointColumns> joints_;
  SeenPeople people_;
};

}  // namespace

bool are_landmark_columns(std::string_view text) {
  const CsvTable table(text, {}, 1);
  if (table.lines().empty()) return false;
  std::map<std::string, int> axes;
  for (const std::string_view name : table.lines().front().cells)
    if (const auto column = column_of(name);
        column && (column->quantity == Quantity::x || column->quantity == Quantity::y))
      ++axes[column->joint];
  return std::ranges::count_if(axes, [](const auto& joint) { return joint.second == 2; }) >= 5;
}

SeenPeople read_landmark_columns(std::string_view text, const std::string& file) {
  return ColumnsReader(text, file).read();
}

}  // namespace mcdbn
