#pragma once

#include <fmt/format.h>

#include <concepts>
#include <string>
#include <string_view>

namespace mcdbn {

/// "1 frame", "0 frames", "2 frames". @param one what one of them is called
template <std::integral Number>
std::string counted(Number number, std::string_view one) {
  return fmt::format("{} {}{}", number, one, number == 1 ? "" : "s");
}

}  // namespace mcdbn
