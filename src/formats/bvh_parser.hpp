#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/shown.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn::bvh {

/// Walks over the words of a BVH text and knows the line it is on.
class Cursor {
 public:
  Cursor(std::string_view text, std::string name, std::vector<std::string>* warnings);

  /// The next word, or an empty view at the end. Braces are words of their own.
  std::string_view next();
  /// Whether nothing but space is left of the text, or of the current line; consumes that space.
  bool at_end();
  bool at_line_end();
  /// What is left of the current line up to a brace, trimmed.
  std::string_view rest_of_line();
  /// Consumes the next word; fails unless it is `word` (letter case ignored).
  void expect(std::string_view word, std::string_view advice);
  /// Consumes the next word as a finite number. @param what for the message
  double number(std::string_view what);

  std::size_t bytes_left() const { return text_.size() - position_; }
  int line() const { return line_; }
  [[noreturn]] void fail(std::string_view what) const { fail_at(line_, what); }
  [[noreturn]] void fail_at(int line, std::string_view what) const;
  void warn(std::string_view what);

 private:
  void skip_space(bool across_lines);

  std::string_view text_;
  std::string name_;
  std::vector<std::string>* warnings_;
  std::size_t position_ = 0;
  int line_ = 1;
};

bool same_word(std::string_view a, std::string_view b);

/// The name of a channel in a CHANNELS line.
std::string_view channel_word(Channel channel);

/// Reads HIERARCHY up to and including MOTION, or up to the end if `motion_follows` is false.
Skeleton parse_hierarchy(Cursor& cursor, bool motion_follows);

}  // namespace mcdbn::bvh
