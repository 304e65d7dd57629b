// DeepLabCut: CSV with header lines scorer, individuals (of several animals), bodyparts and coords;
// predictions with a likelihood, or labels (CollectedData) without. LightningPose writes the same.
// Facts: DeepLabCut's docs, "output of analyze_videos"; pandas' to_csv of its tables.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/numbers.hpp"
#include "base/shown.hpp"
#include "base/text_file.hpp"
#include "formats/csv_table.hpp"
#include "formats/csv_text.hpp"
#include "formats/frame_numbers.hpp"
#include "formats/joint_naming.hpp"
#include "formats/track_formats.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

const char* const kName = "deeplabcut";

const std::set<std::string> kHeaders{"scorer", "individuals", "bodyparts", "coords"};

bool recognises(const TrackSource& source) {
  if (source.is_folder()) return false;
  const CsvTable table(source.text(), source.name(), 4);
  std::set<std::string> headers;
  for (const CsvTable::Line& line : table.lines()) headers.insert(lower(line.cells.front()));
  return headers.contains("bodyparts") && headers.contains("coords");
}

class DeepLabCutReader {
 public:
  explicit DeepLabCutReader(const TrackSource& source)
      : table_(source.text(), source.name()), file_(source.name()) {}

  SeenPeople read() {
    read_headers();
    people_.in_pixels = true;
    const auto numbers = numbers_of_rows();
    for (std::size_t i = headers_; i < table_.lines().size(); ++i)
      read_frame(table_.lines()[i],
                 numbers[i - headers_].value_or(static_cast<long long>(i - headers_)));
    name_joints(people_, parts_);
    return std::move(people_);
  }

 private:
  struct Column {
    std::size_t column, individual, part;
    char quantity;  ///< x, y or l
  };

  /// The cells of the header line of that name, or none.
  const CsvTable::Line* header(const std::string& name) const {
    for (std::size_t i = 0; i < headers_; ++i)
      if (lower(table_.lines()[i].cells.front()) == name) return &table_.lines()[i];
    return nullptr;
  }

  static std::size_t index_in(std::vector<std::string>& names, std::string_view name) {
    const auto found = std::ranges::find(names, name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    names.emplace_back(name);
    return names.size() - 1;
  }

  void read_headers() {
    while (headers_ < table_.lines().size() &&
           kHeaders.contains(lower(table_.lines()[headers_].cells.front())))
      ++headers_;
    const CsvTable::Line *parts = header("bodyparts"), *coords = header("coords");
    const CsvTable::Line* individuals = header("individuals");
    if (parts == nullptr || coords == nullptr)
      throw InputError(fmt::format("{}: no header lines bodyparts and coords", file_));
    width_ = coords->cells.size();
    table_.require_cells(*parts, width_);
    if (individuals != nullptr) table_.require_cells(*individuals, width_);
    std::set<std::tuple<std::size_t, std::size_t, char>> known;
    for (std::size_t k = 1; k < width_; ++k) {
      const std::string quantity = lower(coords->cells[k]);
      if (quantity.empty()) continue;  // of the name of an image that is cut into cells
      if (quantity != "x" && quantity != "y" && quantity != "likelihood")
        table_.fail(*coords,
                    fmt::format("coords {}; x, y and likelihood are known", shown(quantity)));
      const std::size_t individual =
          individuals == nullptr ? 0 : index_in(individuals_, individuals->cells[k]);
      columns_.push_back({k, individual, index_in(parts_, parts->cells[k]), quantity.front()});
      if (!known.emplace(individual, columns_.back().part, quantity.front()).second)
        table_.fail(*coords,
                    fmt::format("{} of {} comes twice", shown(quantity), shown(parts->cells[k])));
    }
    if (columns_.empty()) table_.fail(*coords, "no columns x and y");
    if (individuals_.empty()) individuals_.emplace_back();
    require_joints(parts_.size(), file_);
    if (individuals_.size() > kMostPeople)
      table_.fail(*individuals, fmt::format("{} individuals; at most {} are followed",
                                            individuals_.size(), kMostPeople));
  }

  /// Indices of a video's frames, or the numbers in the names of labelled images; none if they are
  /// not different ones.
  std::vector<std::optional<long long>> numbers_of_rows() const {
    const std::size_t named = columns_.front().column - 1;
    std::vector<std::string> names;
    for (std::size_t i = headers_; i < table_.lines().size(); ++i) {
      const CsvTable::Line& line = table_.lines()[i];
      // Tools leave out the empty cells at the end of a line.
      if (line.cells.size() > width_ || line.cells.size() <= named)
        table_.require_cells(line, width_);
      names.emplace_back(line.cells[named]);
    }
    auto numbers = frame_numbers(names);
    const std::set<std::optional<long long>> different(numbers.begin(), numbers.end());
    if (different.size() < numbers.size() || different.contains(std::nullopt))
      numbers.assign(numbers.size(), std::nullopt);
    return numbers;
  }

  void read_frame(const CsvTable::Line& line, long long number) {
    const std::vector<double> missing(parts_.size(), kNan), ones(parts_.size(), 1.0);
    std::vector<SeenPerson> frame;
    for (std::size_t i = 0; i < individuals_.size(); ++i)
      frame.push_back({missing, missing, ones, static_cast<long long>(i)});
    for (const Column& column : columns_) {
      SeenPerson& person = frame[column.individual];
      auto& values = column.quantity == 'x'   ? person.x_px
                     : column.quantity == 'y' ? person.y_px
                                              : person.confidence;
      values[column.part] = column.quantity == 'l' ? table_.confidence_in(line, column.column)
                                                   : table_.number_in(line, column.column);
    }
    for (SeenPerson& person : frame) mark_missing(person);
    // A line may be short, and each individual has room for all parts.
    std::erase_if(frame, [](const SeenPerson& person) {
      return std::ranges::none_of(person.confidence, [](double sure) { return sure > 0; });
    });
    people_.frames.emplace(number, std::move(frame));
  }

  CsvTable table_;
  std::string file_;
  std::size_t headers_ = 0, width_ = 0;
  std::vector<std::string> individuals_, parts_;
  std::vector<Column> columns_;
  SeenPeople people_;
};

SeenPeople read(const TrackSource& source) {
  return DeepLabCutReader(source).read();
}

void write(const std::filesystem::path& path, const Track2d& track) {
  std::string scorer = "scorer", parts = "bodyparts", coords = "coords";
  for (const std::string& name : track.joint_names) {
    require_csv_name(name);
    scorer += ",mcdbn-cl,mcdbn-cl,mcdbn-cl";
    parts += fmt::format(",{0},{0},{0}", name);
    coords += ",x,y,likelihood";
  }
  std::string text = scorer + "\n" + parts + "\n" + coords + "\n";
  for (int frame = 0; frame < track.frames(); ++frame) {
    text += fmt::format("{}", frame);
    for (int joint = 0; joint < track.joint_count(); ++joint)
      text += track.confidence(frame, joint) > 0
                  ? fmt::format(",{},{},{}", track.x_px(frame, joint), track.y_px(frame, joint),
                                track.confidence(frame, joint))
                  : std::string(",,,0");
    text += '\n';
  }
  write_text_file(path, text);
}

}  // namespace

TrackFormat track_deeplabcut_format() {
  return {kName, "DeepLabCut's and LightningPose's CSV, of one or several animals, and labels",
          {},    recognises,
          read,  write};
}

}  // namespace mcdbn
