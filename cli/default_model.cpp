#include "default_model.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "mcdbn/base/errors.hpp"
#include "program_folder.hpp"

namespace mcdbn::cli {

CLI::Option* add_model_option(CLI::App& command, std::filesystem::path& model) {
  return command
      .add_option("--model", model,
                  "Trained model (default: the general one that comes with the program)")
      ->type_name("FILE");
}

std::filesystem::path model_or_default(const std::filesystem::path& given,
                                       const std::string& instead) {
  if (!given.empty()) return given;
  auto model = beside_program("share/mcdbn-cl/default_model.safetensors");
  if (!std::filesystem::exists(model))
    throw ConfigError(fmt::format("{}: this program comes without the general model; {} is missing",
                                  instead, model.string()));
  spdlog::info("{}: the general one, {}", instead, model.string());
  return model;
}

}  // namespace mcdbn::cli
