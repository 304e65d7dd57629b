#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "base/safetensors.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/cdbn.hpp"
#include "mcdbn/machines/mrbm.hpp"

// Machines among the tensors of a file: `PREFIXW`, `PREFIXA` … for each. What is put says in JSON
// what it needs to be got again; what is got throws InputError naming the file and the tensor.
namespace mcdbn {

/// A file that is being read.
struct TensorFile {
  const Safetensors& content;
  std::string path;  ///< for errors
};

nlohmann::json put_crbm(Safetensors& file, const std::string& prefix, const Crbm& crbm);
Crbm get_crbm(Device& device, const TensorFile& file, const std::string& prefix,
              const nlohmann::json& shape);

/// Layer i has the prefix `PREFIXi.`
nlohmann::json put_cdbn(Safetensors& file, const std::string& prefix, const Cdbn& cdbn);
Cdbn get_cdbn(Device& device, const TensorFile& file, const std::string& prefix,
              const nlohmann::json& shapes);

nlohmann::json put_mrbm(Safetensors& file, const std::string& prefix, const Mrbm& mrbm);
MrbmShape mrbm_shape_from(const nlohmann::json& description);
Mrbm get_mrbm(Device& device, const TensorFile& file, const std::string& prefix,
              const MrbmShape& shape);

/// The JSON under `key` of a file's metadata, of the format's version.
/// @param what the file ought to be, "a model of mcdbn-cl"  @throws InputError
nlohmann::json description_in(const TensorFile& file, const std::string& key,
                              const std::string& what, int format_version);

/// What `read` makes of a description, whose errors say which file is damaged.
template <typename Read>
auto reading_description(const std::string& path, Read&& read) {
  try {
    return read();
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path + ": damaged model description: " + error.what());
  }
}

}  // namespace mcdbn
