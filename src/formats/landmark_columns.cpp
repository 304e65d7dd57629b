// CSV with columns for each landmark: L0_x, L0_y, L0_z, L0_visibility; x1, y1, z1, v1; NOSE_x …
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/numbers.hpp"
#include "base/shown.hpp"
#include "formats/csv_table.hpp"
#include "formats/csv_text.hpp"
#include "formats/field_names.hpp"
#include "formats/frame_times.hpp"
#include "formats/landmarks.hpp"
#include "formats/rate_and_size.hpp"

namespace mcdbn {
namespace {

enum class Quantity { x, y, depth, confidence };

std::optional<Quantity> quantity_of(std::string_view word) {
  const std::string name = lower(word);
  if (name == "x") return Quantity::x;
  if (name == "y") return Quantity::y;
  if (name == "z") return Quantity::depth;
  return is_confidence_name(name) ? std::optional(Quantity::confidence) : std::nullopt;
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

struct JointColumns {
  std::optional<std::size_t> x, y, depth, confidence;

  std::optional<std::size_t>& of(Quantity quantity) {
    switch (quantity) {
      case Quantity::x:
        return x;
      case Quantity::y:
        return y;
      case Quantity::depth:
        return depth;
      default:
        return confidence;
    }
  }
};

class ColumnsReader {
 public:
  ColumnsReader(std::string_view text, const std::string& file) : table_(text, file), file_(file) {}

  SeenPeople read() {
    read_header();
    take_rate_and_size(table_, people_);
    const std::vector<long long> numbers = numbers_of_rows();
    for (std::size_t i = 0; i < numbers.size(); ++i) read_frame(table_.lines()[i + 1], numbers[i]);
    name_landmarks(people_, file_, names_);
    return std::move(people_);
  }

 private:
  void read_header() {
    const CsvTable::Line& header = table_.header();
    for (std::size_t k = 0; k < header.cells.size(); ++k) {
      if (is_frame_name(header.cells[k])) frame_ = k;
      if (!time_ && time_name(header.cells[k])) time_ = k;
      if (!person_ && is_person_column(header.cells[k])) person_ = k;
      const auto column = column_of(header.cells[k]);
      if (!column) continue;
      auto& place = joint_of(column->joint).of(column->quantity);
      // The first of several confidences: visibility before presence.
      if (!place) place = k;
    }
    drop_incomplete();
    drop_world();
    if (joints_.empty()) table_.fail(header, "no landmarks: columns NAME_x and NAME_y");
    people_.has_depths_only = std::ranges::all_of(
        joints_, [](const JointColumns& joint) { return joint.depth && !joint.confidence; });
    if (is_own_motion(header))
      table_.fail(header, "points in space, as regenerate --follow writes them, not a 2D track");
  }

  /// frame,time_s, then x, y, z of each joint: csv_stream() of frame_stream.hpp.
  bool is_own_motion(const CsvTable::Line& header) const {
    return people_.has_depths_only && header.cells.size() == 2 + 3 * joints_.size() &&
           header.cells[0] == "frame" && header.cells[1] == "time_s";
  }

  JointColumns& joint_of(const std::string& name) {
    const std::size_t index = index_of(names_, name);
    joints_.resize(names_.size());
    return joints_[index];
  }

  /// Columns that only look like a landmark's: a score of the whole body.
  void drop_incomplete() {
    for (std::size_t i = joints_.size(); i-- > 0;)
      if (!joints_[i].x || !joints_[i].y) drop(i);
  }

  /// MediaPipe gives places in space beside those in the image.
  void drop_world() {
    const auto is_of_world = [](const std::string& name) {
      return lower(name).find("world") != std::string::npos;
    };
    if (std::ranges::all_of(names_, is_of_world)) return;
    for (std::size_t i = joints_.size(); i-- > 0;)
      if (is_of_world(names_[i])) drop(i);
  }

  void drop(std::size_t joint) {
    joints_.erase(joints_.begin() + static_cast<std::ptrdiff_t>(joint));
    names_.erase(names_.begin() + static_cast<std::ptrdiff_t>(joint));
  }

  long long frame_in(const CsvTable::Line& line) const {
    const double given = table_.number_in(line, *frame_);
    if (!(std::abs(given) < 1e15) || given != std::floor(given))
      table_.fail(line, fmt::format("{} is no number of a frame", shown(line.cells[*frame_])));
    return static_cast<long long>(given);
  }

  /// The frames' numbers as the table gives them, else by their times, else one after the other.
  /// The times become the people's. [rows]
  std::vector<long long> numbers_of_rows() {
    std::vector<long long> numbers;
    std::vector<double> times;
    std::vector<std::string> people;
    for (std::size_t i = 1; i < table_.lines().size(); ++i) {
      const CsvTable::Line& line = table_.lines()[i];
      table_.require_cells(line, table_.header().cells.size());
      if (frame_) numbers.push_back(frame_in(line));
      if (time_) times.push_back(number(line.cells[*time_]).value_or(kNan));
      people.emplace_back(person_ ? line.cells[*person_] : "");
    }
    if (numbers.empty() && do_rise(times, people)) numbers = frames_by_times(times);
    if (numbers.empty()) {
      numbers.resize(people.size());
      std::iota(numbers.begin(), numbers.end(), 0LL);
    }
    if (time_) take_times(people_, table_.header().cells[*time_], numbers, times);
    return numbers;
  }

  void read_frame(const CsvTable::Line& line, long long number) {
    SeenPerson person;
    for (const JointColumns& joint : joints_) {
      person.x_px.push_back(table_.number_in(line, *joint.x));
      person.y_px.push_back(table_.number_in(line, *joint.y));
      person.confidence.push_back(table_.confidence_in(line, joint.confidence));
    }
    mark_missing(person);
    if (person_ && !line.cells[*person_].empty())
      person.id = people_.id_of_track(line.cells[*person_]);
    people_.frames[number].push_back(std::move(person));
  }

  CsvTable table_;
  std::string file_;
  std::optional<std::size_t> frame_, time_, person_;
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
