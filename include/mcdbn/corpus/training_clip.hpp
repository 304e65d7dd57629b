#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mcdbn {

/// A clip that the model was trained on, so that it is not taken for a test.
struct TrainingClip {
  std::string path;  ///< absolute
  /// Hash of the file's bytes, and of an AMC its ASF's too: identifies the clip under any name.
  std::string fingerprint;
  /// Hash of an AMC's bytes alone, as earlier models recorded it; empty of other files.
  std::string former_fingerprint = {};
  std::string person = {}, action = {};  ///< empty where not given
};

/// Path and hashes of a clip's file. @throws InputError if it, or an AMC's ASF, cannot be read
TrainingClip identify_clip(const std::filesystem::path& path);
/// As identify_clip(path), of a file that was read before. @param bytes all that it holds
TrainingClip identify_clip(const std::filesystem::path& path, const std::string& bytes);

/// Whether one of the clips has the same bytes. The ASF of an AMC that an earlier model recorded is
/// not compared.
bool is_among(const std::vector<TrainingClip>& clips, const TrainingClip& clip);

}  // namespace mcdbn
