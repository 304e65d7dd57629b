#include "formats/other_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "base/text_file.hpp"
#include "formats/csv_text.hpp"

namespace mcdbn {
namespace {

using namespace std::string_view_literals;

struct Kind {
  std::size_t at;               ///< the byte where its mark begins
  std::string_view mark, what;  ///< what: the message
};

constexpr auto kFilm = "a film, not a track: let a pose detector find the joints in it first";
constexpr auto kPicture = "a picture, not a track: let a pose detector find the joints in it first";
constexpr auto kPickle =
    "Python's pickle, which is not read: save the keypoints as .npy, frames x joints x 3";
constexpr auto kYoloLabels =
    "YOLO's labels or table, which are not read: write results[i].to_json(), a file for each frame "
    "or a line for each";

constexpr std::array kKinds{
    Kind{0, "\x89HDF\r\n\x1a\n"sv,
         "HDF5 (.h5, .slp), which is not read: export CSV from DeepLabCut "
         "(analyze_videos_converth5_to_csv) or SLEAP (analysis CSV)"},
    Kind{0, "PK\x03\x04"sv,
         "an archive (.npz, .xlsx, .zip), which is not read: save its one array of keypoints as "
         ".npy (frames x joints x 3), or its table as CSV"},
    Kind{0, "\x1f\x8b"sv, "compressed (gzip), which is not read: unpack it first"},
    Kind{0, "\x80\x02"sv, kPickle},
    Kind{0, "\x80\x03"sv, kPickle},
    Kind{0, "\x80\x04"sv, kPickle},
    Kind{0, "\x80\x05"sv, kPickle},
    Kind{4, "ftyp"sv, kFilm},
    Kind{0, "RIFF"sv, kFilm},
    Kind{0, "\x1a\x45\xdf\xa3"sv, kFilm},
    Kind{0, "\x89PNG"sv, kPicture},
    Kind{0, "\xff\xd8\xff"sv, kPicture},
    Kind{0, "PathFileType"sv,
         "TRC, markers or joints without confidences, which is not read: give what the detector "
         "wrote (OpenPose's JSON, CSV)"},
    Kind{0, "HIERARCHY"sv,
         "BVH, which is motion, not a track: the command project makes a track of it"},
    Kind{0, "name,class,confidence,box"sv, kYoloLabels},
    Kind{0, ",name,class,confidence,box"sv, kYoloLabels},
    Kind{0, ":version"sv, "ASF, a skeleton, not a track: name its AMC to have motion"},
    Kind{0, "# AST/ASF"sv, "ASF, a skeleton, not a track: name its AMC to have motion"},
};

/// Ultralytics' `save_txt`: the class, the box, x, y and confidence of 17 joints, and possibly the
/// person's confidence and number.
bool are_yolo_labels(std::string_view text) {
  constexpr std::size_t kNumbers = 5 + 3 * 17;
  const auto words = split(trimmed(text.substr(0, text.find('\n'))), ' ');
  if (words.size() < kNumbers || words.size() > kNumbers + 2) return false;
  const auto object_class = number(words.front());
  return object_class && *object_class == std::floor(*object_class) &&
         std::ranges::all_of(words, [](std::string_view word) { return number(word).has_value(); });
}

bool holds_yolo_labels(const std::filesystem::path& folder) {
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().extension() == ".txt") return are_yolo_labels(read_text_file(entry->path()));
  return false;
}

}  // namespace

std::string what_else_it_is(const TrackSource& source) {
  if (source.is_folder()) return holds_yolo_labels(source.path()) ? kYoloLabels : "";
  const std::string_view text = source.text();
  // C3D begins with the number of its parameter block, then 80.
  if (text.size() >= 512 && text[0] > 0 && text[0] < 9 && text[1] == 'P')
    return "C3D, markers in space, not what one camera saw";
  // OpenSim's motions and storages.
  if (text.substr(0, 4096).find("\nendheader") != std::string_view::npos)
    return "a table of OpenSim (.mot, .sto), angles or forces, not a track";
  if (are_yolo_labels(text)) return kYoloLabels;
  for (const Kind& kind : kKinds)
    if (text.size() > kind.at && text.substr(kind.at).starts_with(kind.mark))
      return std::string(kind.what);
  return {};
}

}  // namespace mcdbn
