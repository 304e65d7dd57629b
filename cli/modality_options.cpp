#include "modality_options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "learning/unit_values.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn::cli {
namespace {

ModalityData& named(std::vector<ModalityData>& modalities, const std::string& name) {
  const auto found = std::find_if(modalities.begin(), modalities.end(),
                                  [&](const ModalityData& one) { return one.name == name; });
  if (found != modalities.end()) return *found;
  modalities.push_back({name, {}, {}});
  return modalities.back();
}

/// File i of each modality holds the same rows.
void check_rows(const ModalityData& one, const ModalityData& first) {
  if (one.data.size() != first.data.size())
    throw InputError(fmt::format("{}: {} files of {}, {} of {}", one.files.files.front().string(),
                                 one.data.size(), one.name, first.data.size(), first.name));
  for (std::size_t i = 0; i < one.data.size(); ++i)
    if (one.data[i].rows() != first.data[i].rows())
      throw InputError(fmt::format("{}: {} rows, {} in {}", one.files.files[i].string(),
                                   one.data[i].rows(), first.data[i].rows(),
                                   first.files.files[i].string()));
}

}  // namespace

void add_modality_option(CLI::App& command, std::vector<std::string>& arguments, const char* help) {
  command.add_option("--modality", arguments, help)->type_name("NAME=FILE")->expected(1, -1);
}

std::vector<ModalityData> read_modalities(const std::vector<std::string>& arguments,
                                          const std::string& tensor) {
  std::vector<ModalityData> modalities;
  for (const std::string& one : arguments) {
    const auto equals = one.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw ConfigError(fmt::format("--modality {}: NAME=FILE is wanted", one));
    named(modalities, one.substr(0, equals)).files.files.emplace_back(one.substr(equals + 1));
  }
  for (ModalityData& modality : modalities) {
    modality.files.tensor = tensor;
    modality.data = modality.files.read();
    check_rows(modality, modalities.front());
  }
  return modalities;
}

const Mrbm& mrbm_of(const SavedMachine& saved, const std::filesystem::path& file,
                    const char* option) {
  if (const Mrbm* mrbm = std::get_if<Mrbm>(&saved.machine)) return *mrbm;
  throw InputError(fmt::format("{}: no MRBM; {} is of one", file.string(), option));
}

std::size_t modality_of(const Mrbm& mrbm, const std::string& name, const char* option) {
  const std::vector<Modality>& modalities = mrbm.shape().modalities;
  const auto found = std::ranges::find(modalities, name, &Modality::name);
  if (found == modalities.end())
    throw ConfigError(fmt::format("{} {}: the MRBM has none of that name", option, name));
  return static_cast<std::size_t>(found - modalities.begin());
}

MrbmUnits mrbm_units(Device& device, const SavedMachine& saved, const Mrbm& mrbm,
                     const std::vector<ModalityData>& inputs, std::size_t copies) {
  std::vector<MatrixF> given(mrbm.modality_count());
  Eigen::Index rows = 1;
  for (const ModalityData& input : inputs) {
    const std::size_t m = modality_of(mrbm, input.name, "--modality");
    for (std::size_t i = 0; i < input.data.size(); ++i)
      check_unit_values(input.data[i], mrbm.kind(m), input.files.files[i].string());
    given[m] = stacked(scaled(saved, input.data, mrbm.visible(m), input.files, m), 0);
    rows = given[m].rows();
  }
  MrbmUnits result;
  for (std::size_t m = 0; m < given.size(); ++m) {
    result.given.push_back(given[m].cols() > 0);
    result.units.push_back(
        result.given[m]
            ? Matrix::from_host(device, given[m].replicate(static_cast<Eigen::Index>(copies), 1))
            : Matrix(device, static_cast<std::size_t>(rows) * copies, mrbm.visible(m)));
  }
  return result;
}

}  // namespace mcdbn::cli
