#include "formats/toml_texts.hpp"

#include <fmt/format.h>

#include "base/text_file.hpp"
#include "base/toml_keys.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

void fail_at(const std::filesystem::path& path, const toml::source_region& source,
             const std::string& what) {
  throw InputError(fmt::format("{}:{}: {}", path.string(), source.begin.line, what));
}

toml::table read_toml(const std::filesystem::path& path, std::string_view example) {
  const std::string text = read_text_file(path);
  if (const auto line = line_of_long_key(text))
    throw InputError(
        fmt::format("{}:{}: a key of too many parts; {}", path.string(), *line, example));
  try {
    return toml::parse(text, path.string());
  } catch (const toml::parse_error& error) {
    fail_at(path, error.source(), fmt::format("not TOML; {}", example));
  }
}

std::string text_of(const std::filesystem::path& path, std::string_view key, const toml::node& node,
                    std::string_view what) {
  const auto* text = node.as_string();
  if (text == nullptr || text->get().empty())
    fail_at(path, node.source(), fmt::format("{}: give {}, in quotes", key, what));
  return text->get();
}

}  // namespace mcdbn
