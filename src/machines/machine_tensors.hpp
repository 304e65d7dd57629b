#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "base/json_place.hpp"
#include "base/safetensors.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/cdbn.hpp"
#include "mcdbn/machines/mrbm.hpp"

// Machines among the tensors of a file: `PREFIXW`, `PREFIXA` … for each. Each put_… returns in
// JSON what get_… needs; get_… throws InputError naming the file and the tensor.
namespace mcdbn {

/// A file that is being read.
struct TensorFile {
  const Safetensors& content;
  std::string path;  ///< for errors
};

/// Finite weights of any size would answer with numbers that are not.
inline constexpr float kLargestWeight = 1e6F;

/// [rows x columns], all finite and of at most `largest`. @throws InputError
MatrixF get_matrix(const TensorFile& file, const std::string& name, std::size_t rows,
                   std::size_t columns, float largest = kLargestWeight);
/// [1 x columns], all above 0 as well. @throws InputError
RowVectorF get_deviation(const TensorFile& file, const std::string& name, std::size_t columns,
                         float largest = kLargestWeight);

nlohmann::json put_crbm(Safetensors& file, const std::string& prefix, const Crbm& crbm);
Crbm get_crbm(Device& device, const TensorFile& file, const std::string& prefix,
              const JsonPlace& shape);

/// Layer i has the prefix `PREFIXi.`
nlohmann::json put_cdbn(Safetensors& file, const std::string& prefix, const Cdbn& cdbn);
Cdbn get_cdbn(Device& device, const TensorFile& file, const std::string& prefix,
              const JsonPlace& shapes);

nlohmann::json put_mrbm(Safetensors& file, const std::string& prefix, const Mrbm& mrbm);
MrbmShape mrbm_shape_from(const JsonPlace& description);
Mrbm get_mrbm(Device& device, const TensorFile& file, const std::string& prefix,
              const MrbmShape& shape);

/// The JSON under `key` of a file's metadata, of the format's version.
/// @param what the file ought to be, "a model of mcdbn-cl"  @throws InputError
nlohmann::json description_in(const TensorFile& file, const std::string& key,
                              const std::string& what, int format_version);

}  // namespace mcdbn
