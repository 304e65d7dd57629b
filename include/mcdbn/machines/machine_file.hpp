#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <variant>
#include <vector>

#include "mcdbn/base/column_scale.hpp"
#include "mcdbn/machines/cdbn.hpp"
#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

/// A machine with the scaling of its data.
struct SavedMachine {
  std::variant<Crbm, Cdbn, Mrbm, Mcdbn> machine;
  /// Scaling of the data before the machine sees them, one of each modality; a scale without
  /// columns, or none: data as they are.
  std::vector<ColumnScale> scales = {};
  nlohmann::json config = {};  ///< the settings that it was fitted with
};

/// One .safetensors file: tensors `W`, `A` … of a CRBM, `0.W` … of a CDBN, `NAME.0.W` … and
/// `mrbm.W_NAME` … of an MCDBN, metadata with format version, shapes and settings, and all else
/// that an Mcdbn holds (docs/formats.md). Written atomically. @throws InputError
void save_machine(const std::filesystem::path& path, const SavedMachine& saved);
/// @throws InputError
SavedMachine load_machine(Device& device, const std::filesystem::path& path);

/// Whether a .safetensors file holds a machine of its own (and not e.g. a model of motion).
/// @throws InputError
bool is_machine_file(const std::filesystem::path& path);
/// The file's own account of itself, for people: kind, sizes, learnt parameters, settings.
/// Needs no device. @throws InputError
nlohmann::json describe_machine(const std::filesystem::path& path);

}  // namespace mcdbn
