#include "setting_flags.hpp"

#include "base/shown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <regex>

namespace mcdbn::cli {
namespace {

/// What stands for the value in the help: "FRAMES".
std::string type_name(const Setting& setting) {
  std::string name = setting.unit.empty() ? "number" : setting.unit;
  std::ranges::transform(name, name.begin(),
                         [](unsigned char letter) { return std::toupper(letter); });
  return name;
}

/// The help of a setting, which begins in lower case, as that of a flag. A symbol stays as it is:
/// "k of CD-k".
std::string as_sentence(std::string help) {
  const bool symbol = help.size() < 2 || (help[1] == ' ' && help[0] != 'a');
  if (!symbol) help[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(help[0])));
  return help;
}

}  // namespace

std::string flag_of(const std::string& setting) {
  std::string flag = "--" + setting;
  std::ranges::replace(flag, '.', '-');
  return flag;
}

std::string with_flags(const std::string& text) {
  static const std::regex quoted("`([a-z][a-zA-Z.-]*)`");
  std::string result;
  auto rest = text.begin();
  for (std::sregex_iterator found(text.begin(), text.end(), quoted), end; found != end; ++found) {
    result.append(rest, (*found)[0].first);
    result += flag_of((*found)[1]);
    rest = (*found)[0].second;
  }
  return result.append(rest, text.end());
}

CLI::Validator in_range(const Range& range) {
  const auto check = [range](const std::string& text) -> std::string {
    const nlohmann::json value = number_in(text);
    if (value.is_number() && range.contains(value.get<double>())) return {};
    return fmt::format("must be {}, not {}", range.text(), shown(text));
  };
  return {check, range.text()};
}

CLI::Option* add_number_flag(CLI::App& command, const std::string& flag, const Setting& setting,
                             const std::function<void(const nlohmann::json&)>& set) {
  const auto take = [set](const std::string& text) { set(number_in(text)); };
  return command
      .add_option_function<std::string>(
          flag, take, fmt::format("{} ({})", as_sentence(setting.help), setting.range.text()))
      ->run_callback_for_default(false)
      ->type_name(type_name(setting));
}

CLI::Option* add_switch_flag(CLI::App& command, const std::string& flag, const Setting& setting,
                             bool usual, const std::function<void(const nlohmann::json&)>& set) {
  const auto take = [set](std::int64_t count) { set(count > 0); };
  return command.add_flag_function(
      flag + ",!--no" + flag.substr(1), take,
      fmt::format("{} (default: {})", as_sentence(setting.help), usual ? "on" : "off"));
}

}  // namespace mcdbn::cli
