#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/json_place.hpp"
#include "base/safetensors.hpp"
#include "mcdbn/machines/mcdbn.hpp"

// Machines among the tensors of a file: `PREFIXW`, `PREFIXA` … for each. Each put_… returns in
// JSON what get_… needs; get_… throws InputError naming the file and the tensor.
namespace mcdbn {

/// A file that is being read.
struct TensorFile {
  const Safetensors& content;
  std::string path;  ///< for errors
};

/// Larger weights would overflow in inference.
inline constexpr float kLargestWeight = 1e6F;
/// Bound of values in the units of the data, which may be large.
inline constexpr float kAnyFinite = std::numeric_limits<float>::max();

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

/// A description's `sampling`.
nlohmann::json sampling_json(const SamplingRule& rule);
/// Algorithm 5's rule where the description has none. @throws InputError
SamplingRule sampling_from(const JsonPlace& description);

/// `PREFIXC` and `PREFIXc`, where it was learnt.
void put_answer_deviation(Safetensors& file, const std::string& prefix,
                          const std::optional<AnswerDeviation>& deviation);
/// Unset where the file has neither. @param answered the CDBN whose code and visible units it fits
std::optional<AnswerDeviation> get_answer_deviation(const TensorFile& file,
                                                    const std::string& prefix,
                                                    const Cdbn& answered);

/// How many numbers of the file's machines are learnt: not the visible units' means, nor the scales
/// of the data.
std::size_t parameter_count(const Safetensors& content);

/// The JSON under `key` of a file's metadata, of the format's version.
/// @param what the file ought to be, "a model of mcdbn-cl"  @throws InputError
nlohmann::json description_in(const TensorFile& file, const std::string& key,
                              const std::string& what, int format_version);

}  // namespace mcdbn
