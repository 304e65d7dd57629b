#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "mcdbn/learning/cd_settings.hpp"
#include "mcdbn/learning/mrbm_settings.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn::cli {

/// What decides which settings a machine is fitted by.
struct MachineParts {
  struct Layer {
    VisibleKind visible;
    bool has_history;
  };
  std::vector<Layer> layers;  ///< from below; none of an MRBM alone
  bool has_mrbm = false;
};

/// Why a setting of `gaussian`, `binary` or `mrbm` has no effect on a machine, after the setting's
/// name in a message; empty if it may have one, and for other settings.
/// @param setting its name with dots
std::string why_unused(const MachineParts& machine, const std::string& setting);

/// Likewise, why it has no effect beside the others of its group. A switch that is off has none to
/// lose.
std::string why_unused(const CdSettings& gaussian, const CdSettings& binary,
                       const MrbmSettings& mrbm, const std::string& setting);

/// The settings of a machine's record that it was fitted with, by their names with dots: those of
/// other kinds of machines and units are left out.
/// @param description as describe_machine gives it
nlohmann::json settings_of(const nlohmann::json& description);

}  // namespace mcdbn::cli
