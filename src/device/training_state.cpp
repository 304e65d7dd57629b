#include "device/training_state.hpp"

#include <fmt/format.h>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

void TrainingState::matrix(const std::string& name, Matrix& value) {
  const std::vector<std::size_t> shape{value.rows(), value.columns()};
  if (!restores_) {
    const MatrixF host = value.to_host();
    content_.matrices[prefix_ + name] = {shape, {host.data(), host.data() + host.size()}};
    return;
  }
  const auto found = content_.matrices.find(prefix_ + name);
  if (found == content_.matrices.end() || found->second.shape != shape)
    throw InputError(fmt::format("{}: of another training: no {} of {} x {}", content_.file,
                                 prefix_ + name, value.rows(), value.columns()));
  value.upload(Eigen::Map<const MatrixF>(found->second.values.data(),
                                         static_cast<Eigen::Index>(value.rows()),
                                         static_cast<Eigen::Index>(value.columns())));
}

const nlohmann::json& TrainingState::at(const std::string& name,
                                        bool (*holds_it)(const nlohmann::json&)) const {
  const auto found = content_.numbers.find(prefix_ + name);
  if (found == content_.numbers.end() || !holds_it(*found))
    throw InputError(fmt::format("{}: of another training: no {}", content_.file, prefix_ + name));
  return *found;
}

}  // namespace mcdbn
