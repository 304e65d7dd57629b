#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "base/counted.hpp"
#include "base/shown.hpp"
#include "commands.hpp"
#include "corpus/corpus_survey.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/joint_map.hpp"

namespace mcdbn::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct CorpusOptions {
  std::vector<fs::path> data;
  fs::path list, joint_map;
};

/// Clips that have something in common, such as their action.
struct Amount {
  std::size_t clips = 0;
  double seconds = 0;
  std::set<std::string> people, actions;
  std::set<std::size_t> skeletons;

  void add(const SurveyedClip& clip) {
    ++clips;
    seconds += clip.seconds();
    people.insert(clip.clip.person);
    actions.insert(clip.clip.action);
    skeletons.insert(clip.skeleton);
  }
};

json clip_json(const SurveyedClip& clip) {
  json problems = json::array();
  for (const ClipProblem& problem : clip.problems)
    problems.push_back({{"kind", name_of(problem.kind)}, {"text", problem.text}});
  return {{"file", clip.clip.file.string()},
          {"person", clip.clip.person},
          {"action", clip.clip.action},
          {"frames", clip.frames},
          {"fps", clip.fps},
          {"seconds", clip.seconds()},
          {"skeleton", clip.skeleton},
          {"usable", clip.usable()},
          {"humanoid", clip.error ? json{{"mean_deg", clip.error->mean_deg()},
                                         {"worst_deg", clip.error->worst_turned().worst_deg},
                                         {"mean_mm", clip.error->mean_mm()},
                                         {"worst_mm", clip.error->worst_placed().worst_mm},
                                         {"on_humanoid_mm", clip.error->humanoid_mm()}}
                                  : json()},
          {"problems", problems}};
}

json survey_json(const std::vector<SurveyedClip>& clips, const Amount& usable) {
  json listed = json::array();
  for (const SurveyedClip& clip : clips) listed.push_back(clip_json(clip));
  return {{"clips", listed},
          {"usable", usable.clips},
          {"people", usable.people},
          {"actions", usable.actions},
          {"skeletons", usable.skeletons.size()},
          {"hours", usable.seconds / 3600}};
}

void print_row(const std::string& name, const Amount& amount) {
  fmt::print("{:<28}{:>8}{:>8}{:>11}{:>10.1f}\n", printable(name), amount.clips,
             amount.people.size(), amount.skeletons.size(), amount.seconds / 60);
}

void print_table(const std::vector<SurveyedClip>& clips, const Amount& usable) {
  std::map<std::string, Amount> actions;
  for (const SurveyedClip& clip : clips)
    if (clip.usable()) actions[clip.clip.action].add(clip);
  fmt::print("{:<28}{:>8}{:>8}{:>11}{:>10}\n", "action", "clips", "people", "skeletons", "minutes");
  for (const auto& [action, amount] : actions) print_row(action, amount);
  print_row(counted(actions.size(), "action"), usable);
  double deg = 0, mm = 0;
  for (const SurveyedClip& clip : clips)
    if (clip.error) {
      deg += clip.error->mean_deg();
      mm += clip.error->mean_mm();
    }
  const auto count = static_cast<double>(std::max<std::size_t>(1, usable.clips));
  fmt::print("\non the canonical humanoid and back: {:.2f} degrees and {:.1f} mm off on average\n",
             deg / count, mm / count);
  std::size_t posed = 0;
  for (const SurveyedClip& clip : clips)
    for (const ClipProblem& problem : clip.problems)
      if (problem.kind == ClipProblem::Kind::first_frame)
        ++posed;
      else
        fmt::print("{}\n", printable(fmt::format("{}: {}", clip.clip.file.string(), problem.text)));
  if (posed > 0)
    fmt::print("{} with a calibration pose first, which training leaves out\n",
               counted(posed, "clip"));
}

void run_corpus(const CommandContext& context, const CorpusOptions& options) {
  const JointMap joint_map =
      options.joint_map.empty() ? JointMap() : read_joint_map(options.joint_map);
  std::vector<std::string> notices;
  const std::vector<SurveyedClip> clips =
      survey(find_listed_clips(options.data), joint_map, &notices);
  for (const std::string& notice : notices) spdlog::warn("{}", notice);
  Amount usable;
  std::vector<ListedClip> listed;
  for (const SurveyedClip& clip : clips)
    if (clip.usable()) {
      usable.add(clip);
      listed.push_back(clip.clip);
    }
  if (context.json)
    print_json(survey_json(clips, usable));
  else
    print_table(clips, usable);
  if (options.list.empty()) return;
  if (listed.empty())
    throw InputError(
        fmt::format("{}: not written, as no clip can be brought onto the canonical humanoid: a "
                    "list without clips is none that `mcdbn-cl train` takes",
                    options.list.string()));
  write_clip_list(options.list, listed);
  spdlog::info("{}: {}, {} left out", options.list.string(), counted(listed.size(), "clip"),
               clips.size() - listed.size());
}

}  // namespace

void add_corpus_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<CorpusOptions>();
  CLI::App* command = app.add_subcommand(
      "corpus", "Lists clips to train on: people, actions, hours, and their problems");
  command
      ->add_option("data", options->data,
                   "BVH or AMC files, folders that hold some, or lists of them")
      ->required()
      ->type_name("PATH");
  mark_output(command->add_option(
                  "-o,--output", options->list,
                  "Also write a list that `train` takes, TOML: the clips that can be brought onto "
                  "the canonical humanoid, with person and action, which may be changed there"),
              context)
      ->type_name("FILE");
  command
      ->add_option(
          "--joint-map", options->joint_map,
          "TOML file of role = \"joint name\", for skeletons whose joint names do not show "
          "the roles; `train` takes it too (docs/joints.md)")
      ->type_name("FILE");
  add_json_option(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl corpus motion/\n"
      "  mcdbn-cl corpus motion/ -o corpus.toml && mcdbn-cl train corpus.toml -o run");
  run_with(*command, context, options, run_corpus);
}

}  // namespace mcdbn::cli
