#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mcdbn {

/// A value given for a setting.
struct GivenSetting {
  std::string name;      ///< "gaussian.rate", or the name that it had before
  nlohmann::json value;  ///< a number, true or false; a text for what is none of these
  std::string who;       ///< stands before "must be" in errors: "run.toml:3: gaussian.rate"
};

}  // namespace mcdbn
