#pragma once

#include <limits>
#include <string>
#include <type_traits>

namespace mcdbn {

/// The numbers that a setting may be: from somewhere to somewhere, never NaN or infinite.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool with_least = true, with_most = true;  ///< whether the ends belong to it

  bool contains(double value) const;  ///< false for NaN and what is infinite
  std::string text() const;           ///< "at least 0 and below 1"
};

/// The upper end where none is given: far beyond any use, and floats still multiply it.
inline constexpr double kLargest = 1e9;

/// Any finite number; for values in files, not for settings.
constexpr Range any_number() {
  return {};
}
constexpr Range at_least(double least, double most = kLargest) {
  return {.least = least, .most = most};
}
constexpr Range above(double limit, double most = kLargest) {
  return {.least = limit, .most = most, .with_least = false};
}
/// For what random numbers start from: TOML's whole numbers hold it.
constexpr Range any_seed() {
  return {.least = 0, .most = 9e18};
}
/// Both ends belong to it.
constexpr Range within(double least, double most) {
  return {.least = least, .most = most};
}
/// Neither end does.
constexpr Range between(double low, double high) {
  return {.least = low, .most = high, .with_least = false, .with_most = false};
}
/// A share of something of which some must be left.
constexpr Range share_below_one() {
  return {.least = 0, .most = 1, .with_most = false};
}
/// For a setting that is true or false.
constexpr Range on_or_off() {
  return {};
}

/// The description of a setting: everything but its value.
///
/// A struct of settings has one static function that names each of its members once:
///
///     template <typename Self, typename Visit>
///     static void visit(Self& self, const Visit& visit) {
///       visit(Setting{"rate", above(0), "", "how far a mini-batch moves the weights"}, self.rate);
///     }
///
/// Members are bool, std::size_t or double. Flags, settings files, the record in a model, the
/// checks of ranges and the help are all made from that.
struct Setting {
  std::string name;  ///< with dots between the names of groups and its own: "gaussian.rate"
  Range range;
  std::string unit;  ///< "frames", "degrees"; empty for a pure number
  std::string help;  ///< one line
};

/// Calls visit(setting, member) for every setting of the struct.
template <typename Settings, typename Visit>
void visit_settings(Settings& settings, const Visit& visit) {
  std::remove_const_t<Settings>::visit(settings, visit);
}

/// As visit_settings(), with "group." before every name: for settings that are members of others.
template <typename Settings, typename Visit>
void visit_group(const std::string& group, Settings& settings, const Visit& visit) {
  visit_settings(settings, [&](Setting setting, auto& member) {
    setting.name = group + "." + setting.name;
    visit(setting, member);
  });
}

/// @param who stands before "must be" in the error
/// @throws ConfigError with the value and the range that it is not in
void check_range(const std::string& who, const Range& range, double value);

/// @throws ConfigError naming the first setting that is out of its range, in backquotes
template <typename Settings>
void check_settings(const Settings& settings) {
  visit_settings(settings, [](const Setting& setting, const auto& value) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, bool>)
      check_range('`' + setting.name + '`', setting.range, static_cast<double>(value));
  });
}

}  // namespace mcdbn
