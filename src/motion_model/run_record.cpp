#include "motion_model/run_record.hpp"

#include <fmt/format.h>

#include "base/json_place.hpp"
#include "base/parsed_json.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/joint_role.hpp"
#include "mcdbn/motion_model/settings_record.hpp"

namespace mcdbn {

namespace fs = std::filesystem;
using nlohmann::json;

void write_run_record(const fs::path& path, const RunRecord& record) {
  json content = {{"settings", settings_json(record.config)},
                  {"skeleton", static_cast<int>(record.config.skeleton)},
                  {"clips", json::array()}};
  for (const ListedClip& clip : record.clips)
    content["clips"].push_back({{"file", fs::absolute(clip.file).lexically_normal().string()},
                                {"person", clip.person},
                                {"action", clip.action}});
  for (const auto& [role, joint] : record.config.joint_map)
    content["joint_map"][std::string(name_of(role))] = joint;
  if (record.from)
    content["from"] = {{"model", record.from->model}, {"fingerprint", record.from->fingerprint}};
  write_text_file(path, content.dump(1) + '\n');
}

RunRecord read_run_record(const fs::path& path) {
  const json parsed = parsed_json(read_text_file(path));
  if (!parsed.is_object())
    throw InputError(fmt::format("{}: not what mcdbn-cl train wrote; train anew", path.string()));
  const JsonPlace content(parsed, path.string());
  const JsonPlace settings = content["settings"];
  if (!settings.is_object()) settings.fail("no settings");
  RunRecord record;
  try {
    record.config = settings_from_json(settings.value());
    record.config.validate();
  } catch (const ConfigError& error) {
    settings.fail(error.what());
  }
  record.config.skeleton = static_cast<SkeletonUse>(
      content["skeleton"].count(within(0, static_cast<double>(SkeletonUse::humanoid))));
  if (content.has("joint_map"))
    for (const std::string& name : content["joint_map"].keys()) {
      const auto role = joint_role_of(name);
      if (!role) content["joint_map"][name].fail("no role of a joint");
      record.config.joint_map[*role] = content["joint_map"][name].text();
    }
  if (content.has("from"))
    record.from = {content["from"]["model"].text(), content["from"]["fingerprint"].text()};
  for (const JsonPlace& clip : content["clips"].list())
    record.clips.emplace_back(clip["file"].text(), clip["person"].text(), clip["action"].text());
  return record;
}

}  // namespace mcdbn
