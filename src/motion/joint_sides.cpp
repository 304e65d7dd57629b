#include "motion/joint_sides.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

namespace mcdbn {
namespace {

/// What in a name marks the side.
struct Mark {
  std::size_t at = 0, length = 0;
  Side side = Side::middle;
};

bool is_upper(char c) {
  return std::isupper(static_cast<unsigned char>(c)) != 0;
}
char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}
char upper(char c) {
  return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
}
bool is_separator(char c) {
  return c == '_' || c == '.' || c == '-' || c == ' ';
}

constexpr std::string_view word_of(Side side) {
  return side == Side::left ? "left" : "right";
}
constexpr Side opposite(Side side) {
  return side == Side::left ? Side::right : Side::left;
}

std::optional<Mark> word_mark(const std::string& name) {
  std::string small = name;
  std::transform(small.begin(), small.end(), small.begin(), lower);
  for (const Side side : {Side::left, Side::right})
    if (const auto at = small.find(word_of(side)); at != std::string::npos)
      return Mark{at, word_of(side).size(), side};
  return std::nullopt;
}

std::optional<Mark> letter_mark(const std::string& name, std::size_t at) {
  const char letter = lower(name[at]);
  if (letter != 'l' && letter != 'r') return std::nullopt;
  return Mark{at, 1, letter == 'l' ? Side::left : Side::right};
}

/// @param capitals whether the first letter of a name in capitals may be a mark
std::optional<Mark> mark_of(const std::string& name, bool capitals) {
  if (const auto word = word_mark(name)) return word;
  const std::size_t n = name.size();
  if (n > 2 && is_separator(name[n - 2]))
    if (const auto last = letter_mark(name, n - 1)) return last;
  if (n < 2) return std::nullopt;
  const bool before_word = is_upper(name[1]) && (capitals || (n > 2 && !is_upper(name[2])));
  if (before_word || is_separator(name[1])) return letter_mark(name, 0);
  return std::nullopt;
}

}  // namespace

Side side_of(const std::string& joint_name) {
  const auto mark = mark_of(joint_name, false);
  return mark ? mark->side : Side::middle;
}

std::vector<std::string> possible_other_sides(const std::string& joint_name) {
  const auto is_letter = [&](std::size_t at) {
    return at < joint_name.size() && std::isalpha(static_cast<unsigned char>(joint_name[at])) != 0;
  };
  std::vector<std::string> names;
  for (std::size_t at = 0; at < joint_name.size(); ++at) {
    const bool begins_capital = at > 0 && is_upper(joint_name[at]) && !is_upper(joint_name[at - 1]);
    const bool begins = at == 0 || !is_letter(at - 1) || begins_capital;
    if (!begins && is_letter(at + 1)) continue;
    const auto mark = letter_mark(joint_name, at);
    if (!mark) continue;
    const char other = word_of(opposite(mark->side)).front();
    names.push_back(joint_name);
    names.back()[at] = is_upper(joint_name[at]) ? upper(other) : other;
  }
  return names;
}

std::string other_side(const std::string& joint_name) {
  const auto mark = mark_of(joint_name, true);
  if (!mark) return {};
  std::string word(word_of(opposite(mark->side)).substr(0, mark->length == 1 ? 1 : 5));
  if (is_upper(joint_name[mark->at])) {
    const bool all = mark->length > 1 && is_upper(joint_name[mark->at + 1]);
    std::transform(word.begin(), all ? word.end() : word.begin() + 1, word.begin(), upper);
  }
  return std::string(joint_name).replace(mark->at, mark->length, word);
}

}  // namespace mcdbn
