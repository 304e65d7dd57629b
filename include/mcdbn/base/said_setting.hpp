#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mcdbn {

/// A value that somebody said for a setting.
struct SaidSetting {
  std::string name;      ///< "gaussian.rate", or the name that it had before
  nlohmann::json value;  ///< a number, true or false
  std::string who;       ///< stands before "must be" in errors: "run.toml:3: gaussian.rate"
};

}  // namespace mcdbn
