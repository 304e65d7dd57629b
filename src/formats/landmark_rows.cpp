// CSV with a row for each landmark of each frame: Frame, LandmarkID, X, Y. A frame in which no
// person was found has no rows.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "base/numbers.hpp"
#include "base/shown.hpp"
#include "formats/csv_table.hpp"
#include "formats/csv_text.hpp"
#include "formats/field_names.hpp"
#include "formats/frame_times.hpp"
#include "formats/joint_naming.hpp"
#include "formats/landmarks.hpp"
#include "formats/rate_and_size.hpp"

namespace mcdbn {
namespace {

struct Header {
  std::optional<std::size_t> frame, time, landmark, x, y, z, confidence, person, model, id;

  /// The column that tells frames apart.
  const std::optional<std::size_t>& frame_or_time() const { return frame ? frame : time; }
};

Header header_of(const CsvTable::Line& line) {
  Header header;
  for (std::size_t k = 0; k < line.cells.size(); ++k) {
    const std::string name = plain(line.cells[k]);
    const auto is = [&](std::initializer_list<const char*> names) {
      return std::ranges::any_of(names, [&](const char* known) { return name == known; });
    };
    const auto take = [&](std::optional<std::size_t>& place) {
      if (!place) place = k;
    };
    if (is_frame_name(line.cells[k])) take(header.frame);
    if (time_name(line.cells[k])) take(header.time);
    if (is({"landmarkid", "landmark", "landmarkidx", "landmarkindex", "landmarkname", "keypoint",
            "keypointid", "keypointname", "joint", "jointid", "jointname", "bodypart", "name"}))
      take(header.landmark);
    if (is({"x", "xpx"})) take(header.x);
    if (is({"y", "ypx"})) take(header.y);
    if (is({"z"})) take(header.z);
    if (is_confidence_name(line.cells[k])) take(header.confidence);
    if (is_person_column(line.cells[k])) take(header.person);
    if (is({"model"})) take(header.model);
    if (is({"id"})) take(header.id);
  }
  if (!header.landmark) header.landmark = header.id;
  return header;
}

class RowsReader {
 public:
  RowsReader(std::string_view text, const std::string& file) : table_(text, file), file_(file) {
    header_ = header_of(table_.header());
    if (!header_.frame_or_time() || !header_.landmark || !header_.x || !header_.y)
      table_.fail(table_.header(), "columns frame or timestamp, landmark, x and y are needed");
    if (header_.model && header_.z)
      table_.fail(table_.header(),
                  "points in space (FreeMoCap), not a 2D track; give the track of one camera");
  }

  SeenPeople read() {
    for (std::size_t i = 1; i < table_.lines().size(); ++i) find_name(table_.lines()[i]);
    sort_numbers();
    if (!numbered_) joints_ = names_.size();
    require_joints(joints_, file_);
    if (!header_.person && header_.id && header_.id != header_.landmark && landmarks_come_again())
      header_.person = header_.id;
    SeenPeople people;
    take_rate_and_size(table_, people);
    const std::vector<long long> numbers = frames_of_rows(people);
    for (std::size_t i = 0; i < numbers.size(); ++i) read_row(table_.lines()[i + 1], numbers[i]);
    for (auto& [frame, bodies] : frames_) {
      auto& list = people.frames[frame];
      for (auto& [person, body] : bodies) {
        mark_missing(body);
        if (header_.person) body.id = person;
        list.push_back(std::move(body));
      }
    }
    people.has_depths_only = header_.z && !header_.confidence;
    name_landmarks(people, file_, numbered_ ? std::vector<std::string>{} : names_);
    return people;
  }

 private:
  void find_name(const CsvTable::Line& line) {
    table_.require_cells(line, table_.header().cells.size());
    if (const auto name = line.cells[*header_.landmark];
        columns_.emplace(name, names_.size()).second)
      names_.emplace_back(name);
  }

  /// Landmarks that are numbers stand in the order of these; those that were never seen keep their
  /// column. Numbers count from 1 where 0 never comes and the last number is a joint count that is
  /// known: 1 to 17 are 17 joints. Else they count from 0.
  void sort_numbers() {
    std::vector<double> numbers;
    for (const std::string& name : names_) {
      const auto value = number(name);
      if (!value || *value != std::floor(*value) || *value < 0 || *value > 1000) return;
      numbers.push_back(*value);
    }
    if (numbers.empty()) return;
    numbered_ = true;
    const auto last = static_cast<std::size_t>(*std::ranges::max_element(numbers));
    const std::size_t first =
        std::ranges::find(numbers, 0) == numbers.end() && is_joint_count(last) ? 1 : 0;
    for (std::size_t i = 0; i < names_.size(); ++i)
      columns_[names_[i]] = static_cast<std::size_t>(numbers[i]) - first;
    joints_ = last + 1 - first;
  }

  /// Whether a frame has a landmark twice: `id` is then the person's number, else the landmark's.
  bool landmarks_come_again() const {
    std::set<std::pair<std::string_view, std::string_view>> known;
    for (std::size_t i = 1; i < table_.lines().size(); ++i) {
      const auto& cells = table_.lines()[i].cells;
      if (!known.emplace(cells[*header_.frame_or_time()], cells[*header_.landmark]).second)
        return true;
    }
    return false;
  }

  long long whole(const CsvTable::Line& line, std::size_t column) const {
    const double value = table_.number_in(line, column);
    if (!(std::abs(value) < 1e15) || value != std::floor(value))
      table_.fail(line, fmt::format("{} is no whole number", shown(line.cells[column])));
    return static_cast<long long>(value);
  }

  /// The frames' numbers as the table gives them, else by their times, which become the people's.
  /// [rows]
  std::vector<long long> frames_of_rows(SeenPeople& people) const {
    std::vector<long long> numbers;
    std::vector<double> times;
    for (std::size_t i = 1; i < table_.lines().size(); ++i) {
      const CsvTable::Line& line = table_.lines()[i];
      if (header_.frame) numbers.push_back(whole(line, *header_.frame));
      if (header_.time) times.push_back(number(line.cells[*header_.time]).value_or(kNan));
    }
    if (!header_.frame) numbers = frames_by_times(times);
    if (numbers.size() < times.size())
      table_.fail(table_.header(), "a row without a time; add a column frame, a number");
    if (header_.time) take_times(people, table_.header().cells[*header_.time], numbers, times);
    return numbers;
  }

  void read_row(const CsvTable::Line& line, long long frame) {
    const long long person = header_.person ? whole(line, *header_.person) : 0;
    SeenPerson& body = frames_[frame][person];
    constexpr double kNoRow = -1;  // a confidence that comes to be missing
    if (body.x_px.empty()) {
      body.x_px.assign(joints_, kNan);
      body.y_px.assign(joints_, kNan);
      body.confidence.assign(joints_, kNoRow);
    }
    const std::string_view landmark = line.cells[*header_.landmark];
    const std::size_t joint = columns_.at(std::string(landmark));
    if (body.confidence[joint] != kNoRow)
      table_.fail(line,
                  fmt::format("landmark {} comes twice in frame {}; {}", shown(landmark),
                              shown(line.cells[*header_.frame_or_time()]),
                              header_.person ? "remove one row" : "add a column person, a number"));
    body.x_px[joint] = table_.number_in(line, *header_.x);
    body.y_px[joint] = table_.number_in(line, *header_.y);
    body.confidence[joint] = table_.confidence_in(line, header_.confidence);
  }

  CsvTable table_;
  std::string file_;
  Header header_;
  bool numbered_ = false;
  std::size_t joints_ = 0;
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> columns_;
  std::map<long long, std::map<long long, SeenPerson>> frames_;
};

}  // namespace

bool are_landmark_rows(std::string_view text) {
  const CsvTable table(text, {}, 1);
  if (table.lines().empty()) return false;
  const Header header = header_of(table.lines().front());
  return header.frame_or_time() && header.landmark && header.x && header.y;
}

SeenPeople read_landmark_rows(std::string_view text, const std::string& file) {
  return RowsReader(text, file).read();
}

}  // namespace mcdbn
