#pragma once

#include <nlohmann/json_fwd.hpp>

namespace mcdbn::cli {

/// The settings of a machine's record that it was fitted with, by their names with dots: those of
/// other kinds of machines and units are left out.
/// @param description as describe_machine gives it
nlohmann::json settings_of(const nlohmann::json& description);

}  // namespace mcdbn::cli
