#pragma once

#include <string_view>

namespace mcdbn {

/// How a report calls a method.
struct MethodName {
  std::string_view key;       ///< in summary.json and tables
  std::string_view title;     ///< in charts
  std::string_view spoken;    ///< within a sentence
  std::string_view sentence;  ///< what it is
};

/// @param key one that is not known is called as it is, without a sentence; it must live on
MethodName method_name(std::string_view key);

}  // namespace mcdbn
