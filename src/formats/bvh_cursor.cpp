#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "formats/bvh_parser.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn::bvh {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}
bool is_brace(char c) {
  return c == '{' || c == '}';
}
char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

}  // namespace

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

Cursor::Cursor(std::string_view text, std::string name, std::vector<std::string>* warnings)
    : text_(text), name_(std::move(name)), warnings_(warnings) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
  if (text_.find('\0') != std::string_view::npos) {
    fail("is not plain text, export it as a BVH file in ASCII or UTF-8");
  }
}

void Cursor::skip_space(bool across_lines) {
  for (; position_ < text_.size(); ++position_) {
    const char c = text_[position_];
    if (c == '\n') {
      if (!across_lines) return;
      ++line_;
    } else if (!is_space(c)) {
      return;
    }
  }
}

bool Cursor::at_end() {
  skip_space(true);
  return position_ == text_.size();
}

bool Cursor::at_line_end() {
  skip_space(false);
  return position_ == text_.size() || text_[position_] == '\n';
}

std::string_view Cursor::next() {
  if (at_end()) return {};
  const std::size_t begin = position_;
  if (is_brace(text_[begin])) return text_.substr(position_++, 1);
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (is_space(c) || c == '\n' || is_brace(c)) break;
    ++position_;
  }
  return text_.substr(begin, position_ - begin);
}

std::string_view Cursor::rest_of_line() {
  skip_space(false);
  const std::size_t begin = position_;
  while (position_ < text_.size() && text_[position_] != '\n' && !is_brace(text_[position_]))
    ++position_;
  std::string_view rest = text_.substr(begin, position_ - begin);
  while (!rest.empty() && is_space(rest.back())) rest.remove_suffix(1);
  return rest;
}

void Cursor::expect(std::string_view word, std::string_view advice) {
  const std::string_view found = next();
  if (same_word(found, word)) return;
  fail(found.empty() ? fmt::format("the file ends where '{}' should stand, {}", word, advice)
                     : fmt::format("{} where '{}' should stand, {}", shown(found), word, advice));
}

double Cursor::number(std::string_view what) {
  const std::string_view word = next();
  if (word.empty()) fail(fmt::format("the file ends where {} should stand", what));
  std::string_view digits = word;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::invalid_argument || end != digits.data() + digits.size()) {
    fail(fmt::format("{} is not a number, {} should stand here", shown(word), what));
  }
  // Out of range with a negative exponent is too small to differ from zero.
  if (error == std::errc::result_out_of_range && digits.find("e-") == std::string_view::npos &&
      digits.find("E-") == std::string_view::npos) {
    value = HUGE_VAL;
  }
  if (!std::isfinite(value)) {
    fail(fmt::format("{} is not a finite number, repair or re-export this value", shown(word)));
  }
  return value;
}

void Cursor::fail_at(int line, std::string_view what) const {
  throw InputError(fmt::format("{}:{}: {}", name_, line, what));
}

void Cursor::warn(std::string_view what) {
  if (warnings_) warnings_->push_back(fmt::format("{}:{}: {}", name_, line_, what));
}

}  // namespace mcdbn::bvh
