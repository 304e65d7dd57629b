#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace mcdbn::test {

/// Something that reads files of others. Whatever the bytes, they are read, or refused with an
/// InputError (settings: a ConfigError) that names the file; all else is a finding.
struct Reader {
  std::string name;    ///< also of its folders of seeds and findings, and of its dictionary
  std::string ending;  ///< of the files that it reads
  /// Also checks that what was read can be used.
  std::function<void(const std::filesystem::path&)> read;
};

/// All that there are.
const std::vector<Reader>& readers();

/// The reader's message about these bytes; empty if it reads them.
/// @throws whatever came out that should not, std::logic_error for a message that is none
std::string refusal(const Reader& reader, std::string_view bytes);

}  // namespace mcdbn::test
