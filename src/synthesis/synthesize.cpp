#include "mcdbn/synthesis/synthesize.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mcdbn/base/errors.hpp"
#include "synthesis/synthesize_actions.hpp"

namespace mcdbn {
namespace {

using namespace synthesis;

constexpr double kShortest_s = 0.5, kLongest_s = 3600, kHighest_fps = 1000;

void check(const SynthesisOptions& options) {
  if (!(options.fps >= 1 && options.fps <= kHighest_fps)) {
    throw ConfigError(
        fmt::format("fps is {}: choose 1 to {} frames a second", options.fps, kHighest_fps));
  }
  if (!(options.seconds >= kShortest_s && options.seconds <= kLongest_s)) {
    throw ConfigError(fmt::format("seconds is {}: choose {} to {} seconds a clip", options.seconds,
                                  kShortest_s, kLongest_s));
  }
  if (options.subject < 1 || options.clip < 1) {
    throw ConfigError(
        fmt::format("subject {} and clip {}: both count from 1", options.subject, options.clip));
  }
}

std::vector<Frame> perform(SynthesisAction action, ClipSetup& setup) {
  switch (action) {
    case SynthesisAction::walk:
      return walk(setup);
    case SynthesisAction::jump:
      return jump(setup);
    case SynthesisAction::jumping_jacks:
      return jumping_jacks(setup);
    case SynthesisAction::wave_one:
      return wave(setup, 1);
    case SynthesisAction::wave_two:
      return wave(setup, 2);
    case SynthesisAction::clap:
      return clap(setup);
    case SynthesisAction::throw_object:
      return throw_object(setup);
  }
  throw ConfigError("unknown action");
}

/// Slow drift of every angle, as no living body holds still or repeats itself.
void add_drift(std::vector<Frame>& frames, double fps, Random& random) {
  constexpr double kFrequency_hz = 0.35;
  std::array<SlowNoise, kDofCount> noise;
  for (int dof = 0; dof < kDofCount; ++dof) {
    const double deviation_deg = dof < kTrunkFlex ? 0.4 : dof < kHeadNod ? 0.7 : 1.6;
    noise[static_cast<std::size_t>(dof)] = SlowNoise(random, deviation_deg, kFrequency_hz);
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (int dof = 0; dof < kDofCount; ++dof) {
      frames[i].posture[dof] += noise[static_cast<std::size_t>(dof)](static_cast<double>(i) / fps);
    }
  }
}

/// Moves the first frame's hips over the origin and turns everything about it.
void face(std::vector<Frame>& frames, double heading_deg) {
  const Eigen::Vector3d start(frames.front().hips.x(), 0, frames.front().hips.z());
  const Eigen::Matrix3d turn = rotation_y(heading_deg);
  for (Frame& frame : frames) {
    frame.heading_deg += heading_deg;
    frame.hips = turn * (frame.hips - start);
    for (Foot& foot : frame.feet) {
      foot.ankle = turn * (foot.ankle - start);
      foot.turn_deg += heading_deg;
    }
  }
}

}  // namespace

const std::vector<SynthesisAction>& synthesis_actions() {
  static const std::vector<SynthesisAction> kActions{
      SynthesisAction::walk,        SynthesisAction::jump,     SynthesisAction::jumping_jacks,
      SynthesisAction::wave_one,    SynthesisAction::wave_two, SynthesisAction::clap,
      SynthesisAction::throw_object};
  return kActions;
}

std::string_view synthesis_action_name(SynthesisAction action) {
  constexpr std::array<std::string_view, 7> kNames{"walk",     "jump", "jumping-jacks", "wave-one",
                                                   "wave-two", "clap", "throw"};
  return kNames.at(static_cast<std::size_t>(action));
}

SynthesisAction parse_synthesis_action(std::string_view name) {
  std::string known;
  for (const SynthesisAction action : synthesis_actions()) {
    if (synthesis_action_name(action) == name) return action;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", synthesis_action_name(action));
  }
  throw ConfigError(fmt::format("no action is called '{}': choose one of {}", name, known));
}

Motion synthesize(const SynthesisOptions& options) {
  check(options);
  const auto subject = static_cast<std::uint64_t>(options.subject);
  const auto clip = static_cast<std::uint64_t>(options.clip);
  const auto action = static_cast<std::uint64_t>(options.action);
  // The person is the same in every action and clip.
  Random person({options.seed, subject});
  const Body body = Body::draw(person);
  const Style style = Style::draw(person);
  const int frames = std::max(2, static_cast<int>(std::lround(options.seconds * options.fps)));
  ClipSetup setup{body, style, Random({options.seed, subject, clip, action}), options.fps, frames};
  const double heading_deg = setup.random.normal(0, 12);
  std::vector<Frame> performed = perform(options.action, setup);
  add_drift(performed, options.fps, setup.random);
  face(performed, heading_deg);
  return assemble(body, std::move(performed), options.fps);
}

std::string synthesis_file_name(const SynthesisOptions& options) {
  return fmt::format("{}_s{:02}_{:02}.bvh", synthesis_action_name(options.action), options.subject,
                     options.clip);
}

}  // namespace mcdbn
