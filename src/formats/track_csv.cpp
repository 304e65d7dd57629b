#include "mcdbn/formats/track_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/interruption.hpp"
#include "base/numbers.hpp"
#include "base/shown.hpp"
#include "base/text_file.hpp"
#include "formats/csv_text.hpp"
#include "formats/joint_naming.hpp"
#include "formats/track_formats.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/motion/frame_rate.hpp"

namespace mcdbn {

namespace {

/// Where a column's numbers go.
enum class Quantity { time, x, y, confidence };
struct Column {
  Quantity quantity;
  int joint;
};

class TrackReader {
 public:
  /// @param lines_before the text, which messages count
  explicit TrackReader(std::string name, int lines_before = 0)
      : name_(std::move(name)), line_(lines_before) {}

  Track2d read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    for (const std::string_view line : split(text, '\n')) {
      ++line_;
      check_interruption();
      if (line.empty()) continue;
      if (line.front() == '#') {
        read_comment(line.substr(1));
      } else if (columns_.empty()) {
        read_header(cells_of(line));
      } else {
        read_row(cells_of(line));
      }
    }
    if (columns_.empty()) fail("no header line; name the columns joint_x_px, joint_y_px, ...");
    if (rows_.empty()) fail("no frames below the header; give one line a frame");
    fill_track();
    return std::move(track_);
  }

  bool gives_fps() const { return gives_fps_; }
  bool gives_size() const { return gives_width_ && gives_height_; }
  const std::vector<std::string>& notices() const { return notices_; }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", name_, line_, what));
  }

  static std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells = split(line, ',');
    for (std::string_view& cell : cells) cell = without_quotes(cell);
    return cells;
  }

  /// `fps=30 width_px=1920 height_px=1080` among any other words.
  void read_comment(std::string_view comment) {
    // Spreadsheets fill the line up to the table's width.
    comment = comment.substr(0, comment.find_last_not_of(", \t") + 1);
    for (const std::string_view word : split(comment, ' ')) {
      const auto equals = word.find('=');
      if (equals == std::string_view::npos) continue;
      const std::string_view key = word.substr(0, equals);
      if (key != "fps" && key != "width_px" && key != "height_px") continue;
      const double value = number(word.substr(equals + 1)).value_or(kNan);
      const Range range = key == "fps" ? kFrameRate_hz : Camera::kImage_px;
      if (!range.contains(value) || (key != "fps" && value != std::floor(value))) {
        fail(
            fmt::format("{} has no usable value; write a number of {}", shown(word), range.text()));
      }
      (key == "fps" ? gives_fps_ : key == "width_px" ? gives_width_ : gives_height_) = true;
      if (key == "fps") track_.fps = value;
      if (key == "width_px") track_.width_px = static_cast<int>(value);
      if (key == "height_px") track_.height_px = static_cast<int>(value);
    }
  }

  void read_header(const std::vector<std::string_view>& names) {
    const auto is_number = [](std::string_view cell) { return cell.empty() || number(cell); };
    if (std::all_of(names.begin(), names.end(), is_number)) {
      fail("numbers where the header is expected; name the columns joint_x_px, joint_y_px, ...");
    }
    for (const std::string_view name : names) {
      const Column column = parse_column_name(name);
      const auto same = [&](const Column& other) {
        return other.quantity == column.quantity && other.joint == column.joint;
      };
      if (std::any_of(columns_.begin(), columns_.end(), same)) {
        fail(fmt::format("column {} comes twice; remove one", shown(name)));
      }
      columns_.push_back(column);
    }
    for (int joint = 0; joint < track_.joint_count(); ++joint) require_both_axes(joint);
    if (track_.joint_names.empty()) fail("no joint columns; name them joint_x_px, joint_y_px, ...");
  }

  Column parse_column_name(std::string_view name) {
    if (name == "time_s") {
      if (!columns_.empty()) fail("time_s is not the first column; put it first");
      return {Quantity::time, -1};
    }
    constexpr std::pair<std::string_view, Quantity> kEndings[] = {
        {"_x_px", Quantity::x}, {"_y_px", Quantity::y}, {"_confidence", Quantity::confidence}};
    for (const auto& [ending, quantity] : kEndings) {
      if (name.size() <= ending.size() || !name.ends_with(ending)) continue;
      const std::string joint(name.substr(0, name.size() - ending.size()));
      int index = track_.find(joint);
      if (index < 0) {
        index = track_.joint_count();
        track_.joint_names.push_back(joint);
      }
      return {quantity, index};
    }
    fail(fmt::format("unknown column {}; columns end in _x_px, _y_px or _confidence", shown(name)));
  }

  bool has_column(Quantity quantity, int joint) const {
    return std::any_of(columns_.begin(), columns_.end(), [&](const Column& column) {
      return column.quantity == quantity && column.joint == joint;
    });
  }

  void require_both_axes(int joint) const {
    const std::string& name = track_.joint_names[joint];
    for (const auto& [quantity, ending] :
         {std::pair{Quantity::x, "_x_px"}, std::pair{Quantity::y, "_y_px"}}) {
      if (!has_column(quantity, joint)) {
        fail(fmt::format("joint {} has no column {}; add it or remove the joint", shown(name),
                         shown(name + std::string(ending))));
      }
    }
  }

  void read_row(const std::vector<std::string_view>& cells) {
    if (cells.size() != columns_.size()) {
      fail(fmt::format("{} cells where the header has {} columns; complete the line", cells.size(),
                       columns_.size()));
    }
    RowVectorD row(static_cast<Eigen::Index>(cells.size()));
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const std::optional<double> value = cells[k].empty() ? kNan : number(cells[k]);
      if (!value) {
        fail(
            fmt::format("{} in column {} is not a number; leave the cell empty where the joint "
                        "was not seen",
                        shown(cells[k]), k + 1));
      }
      row[static_cast<Eigen::Index>(k)] = *value;
      if (columns_[k].quantity == Quantity::confidence && *value < 0) {
        fail(fmt::format("confidence {} is below 0; use 0 for a joint that was not seen", *value));
      }
    }
    if (columns_.front().quantity == Quantity::time) require_later(row[0]);
    rows_.push_back(std::move(row));
  }

  void require_later(double time_s) const {
    if (std::isnan(time_s) || (!rows_.empty() && time_s <= rows_.back()[0])) {
      fail("time_s does not rise from line to line; sort the lines by time");
    }
  }

  void fill_track() {
    const auto frames = static_cast<Eigen::Index>(rows_.size());
    const int joints = track_.joint_count();
    track_.x_px = track_.y_px = MatrixD::Constant(frames, joints, kNan);
    track_.confidence = MatrixD::Ones(frames, joints);
    for (Eigen::Index frame = 0; frame < frames; ++frame) {
      for (std::size_t k = 0; k < columns_.size(); ++k) {
        const double value = rows_[frame][static_cast<Eigen::Index>(k)];
        const int joint = columns_[k].joint;
        if (columns_[k].quantity == Quantity::x) track_.x_px(frame, joint) = value;
        if (columns_[k].quantity == Quantity::y) track_.y_px(frame, joint) = value;
        if (columns_[k].quantity == Quantity::confidence && !std::isnan(value)) {
          track_.confidence(frame, joint) = value;
        }
      }
    }
    const auto missing = track_.x_px.array().isNaN() || track_.y_px.array().isNaN() ||
                         (track_.x_px.array() == 0 && track_.y_px.array() == 0) ||
                         track_.confidence.array() == 0;
    // Evaluated first: the expression reads what the next lines change.
    const Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> gone = missing;
    track_.x_px = gone.select(kNan, track_.x_px);
    track_.y_px = gone.select(kNan, track_.y_px);
    track_.confidence = gone.select(0.0, track_.confidence);
    if (columns_.front().quantity == Quantity::time && frames > 1) {
      take_rate_of_times();
    }
  }

  void take_rate_of_times() {
    const auto time_s = [&](std::size_t row) { return rows_[row][0]; };
    track_.fps = static_cast<double>(rows_.size() - 1) / (time_s(rows_.size() - 1) - time_s(0));
    if (!kFrameRate_hz.contains(track_.fps))
      fail(fmt::format("time_s makes {:g} frames a second, which must be {}; write seconds",
                       track_.fps, kFrameRate_hz.text()));
    gives_fps_ = true;
    double shortest_s = time_s(1) - time_s(0), longest_s = shortest_s;
    for (std::size_t row = 1; row < rows_.size(); ++row) {
      shortest_s = std::min(shortest_s, time_s(row) - time_s(row - 1));
      longest_s = std::max(longest_s, time_s(row) - time_s(row - 1));
    }
    constexpr double kEven = 1.5;  // a frame that is left out makes 2
    if (longest_s > kEven * shortest_s)
      notices_.push_back(
          fmt::format("time_s goes on by {:.4g} to {:.4g} s: frames are taken as even, {:.4g} a "
                      "second; put in a line for each that is left out",
                      shortest_s, longest_s, track_.fps));
  }

  std::string name_;
  int line_;
  bool gives_fps_ = false, gives_width_ = false, gives_height_ = false;
  Track2d track_;
  std::vector<Column> columns_;
  std::vector<RowVectorD> rows_;
  std::vector<std::string> notices_;
};

std::string cell(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

bool recognises(const TrackSource& source) {
  if (source.is_folder()) return false;
  std::string_view text = source.text();
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    if (!line.empty() && line.front() != '#') return line.find("_x_px") != std::string_view::npos;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return false;
}

SeenPeople read(const TrackSource& source) {
  TrackReader reader(source.name(), source.lines_before());
  const Track2d track = reader.read(source.text());
  SeenPeople people;
  people.in_pixels = true;
  if (are_a_detectors(track.joint_names))
    name_joints(people, track.joint_names);
  else
    people.joint_names = track.joint_names;
  for (Eigen::Index frame = 0; frame < track.frames(); ++frame) {
    const auto row_of = [&](const MatrixD& values) {
      return std::vector<double>(values.row(frame).begin(), values.row(frame).end());
    };
    people.frames[frame] = {{row_of(track.x_px), row_of(track.y_px), row_of(track.confidence), 1}};
  }
  people.notices = reader.notices();
  if (reader.gives_fps()) people.fps = track.fps;
  people.image_size = ImageSize{track.width_px, track.height_px};
  people.image_size_is_given = reader.gives_size();
  return people;
}

}  // namespace

Track2d read_track_csv(const std::filesystem::path& path) {
  return TrackReader(path.string()).read(read_text_file(path));
}

void write_track_csv(const std::filesystem::path& path, const Track2d& track) {
  std::string text = fmt::format("# fps={} width_px={} height_px={}\n", track.fps, track.width_px,
                                 track.height_px);
  for (int joint = 0; joint < track.joint_count(); ++joint) {
    const std::string& name = track.joint_names[joint];
    require_csv_name(name);
    text += fmt::format("{1}{0}_x_px,{0}_y_px,{0}_confidence", name, joint == 0 ? "" : ",");
  }
  text += '\n';
  for (int frame = 0; frame < track.frames(); ++frame) {
    check_interruption();
    for (int joint = 0; joint < track.joint_count(); ++joint) {
      text += fmt::format("{}{},{},{}", joint == 0 ? "" : ",", cell(track.x_px(frame, joint)),
                          cell(track.y_px(frame, joint)), cell(track.confidence(frame, joint)));
    }
    text += '\n';
  }
  write_text_file(path, text);
}

TrackFormat track_csv_format() {
  return {"csv", "our own: columns joint_x_px, joint_y_px, joint_confidence and time_s",
          {},    recognises,
          read,  write_track_csv};
}

}  // namespace mcdbn
