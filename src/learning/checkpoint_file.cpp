#include "learning/checkpoint_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/json_place.hpp"
#include "base/parsed_json.hpp"
#include "base/safetensors.hpp"
#include "base/shown.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kKey = "mcdbn-checkpoint";
constexpr int kCheckpointVersion = 1;
/// Between the name of a stage and that of a matrix.
constexpr char kBetween = '/';

void put(Safetensors& file, const std::string& stage, const TrainingState::Content& content) {
  const std::string prefix = stage + kBetween;
  for (const auto& [name, tensor] : content.matrices)
    file.tensors[std::string(prefix).append(name)] = tensor;
}

/// Numbers and booleans by name, each finite.
json numbers_of(const JsonPlace& place) {
  json numbers = json::object();
  for (const std::string& name : place.keys()) {
    const JsonPlace number = place[name];
    if (!number.value().is_boolean()) number.number(any_number());
    numbers[name] = number.value();
  }
  return numbers;
}

void check_finite(const Safetensors& file, const std::string& path) {
  for (const auto& [name, tensor] : file.tensors)
    if (!std::ranges::all_of(tensor.values, [](float value) { return std::isfinite(value); }))
      throw InputError(
          fmt::format("{}: tensor {} holds a number that is not finite", path, shown(name)));
}

TrainingState::Content content_of(const Safetensors& file, const std::string& path,
                                  const std::string& stage, const JsonPlace& numbers) {
  TrainingState::Content content{numbers_of(numbers), {}, path};
  const std::string prefix = stage + kBetween;
  for (auto found = file.tensors.lower_bound(prefix);
       found != file.tensors.end() && found->first.starts_with(prefix); ++found)
    content.matrices[found->first.substr(prefix.size())] = found->second;
  return content;
}

}  // namespace

void write_checkpoint(const fs::path& path, const CheckpointContent& content) {
  Safetensors file;
  json about = {{"format_version", kCheckpointVersion}, {"over", json::object()},
                {"stage", content.running_stage},       {"done", content.done_minibatches},
                {"now", content.running_state.numbers}, {"more", content.extra_state.numbers}};
  for (const auto& [stage, result] : content.finished_stages) {
    about["over"][stage] = result.numbers;
    put(file, stage, result);
  }
  put(file, content.running_stage, content.running_state);
  file.metadata[kKey] = about.dump();
  write_safetensors(path, file);
}

CheckpointContent read_checkpoint(const fs::path& path) {
  const Safetensors file = read_safetensors(path);
  const auto text = file.metadata.find(kKey);
  if (text == file.metadata.end())
    throw InputError(fmt::format("{}: no checkpoint of mcdbn-cl", path.string()));
  const json parsed = parsed_json(text->second);
  if (!parsed.is_object())
    throw InputError(fmt::format("{}: damaged: its description is no JSON", path.string()));
  const JsonPlace about(parsed, path.string());
  if (about["format_version"].value() != kCheckpointVersion)
    about["format_version"].fail("of another version of mcdbn-cl; train anew");
  check_finite(file, path.string());
  CheckpointContent content;
  const JsonPlace over = about["over"];
  for (const std::string& stage : over.keys())
    content.finished_stages[stage] = content_of(file, path.string(), stage, over[stage]);
  content.running_stage = about["stage"].text();
  content.done_minibatches = about["done"].count(any_seed());
  content.running_state = content_of(file, path.string(), content.running_stage, about["now"]);
  content.extra_state = {numbers_of(about["more"]), {}, path.string()};
  return content;
}

}  // namespace mcdbn
