// The room synthesis: parametric human motion, for demonstrations and tests.
// It uses motion.
// Add here: an action: synthesize_ACTION.cpp and a line in synthesize_actions.hpp.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

enum class SynthesisAction { walk, jump, jumping_jacks, wave_one, wave_two, clap, throw_object };

/// Every action, in the order of the enumeration.
const std::vector<SynthesisAction>& synthesis_actions();
/// The action's name on the command line and in file names: walk, jump, jumping-jacks, wave-one, …
std::string_view synthesis_action_name(SynthesisAction action);
/// @throws ConfigError that lists the actions
SynthesisAction parse_synthesis_action(std::string_view name);

struct SynthesisOptions {
  SynthesisAction action = SynthesisAction::walk;
  int subject = 1;  ///< decides the body and the personal style, the same in every action
  int clip = 1;     ///< decides tempo, amplitude, heading and the slow drift of this clip
  std::uint64_t seed = 1;
  double fps = 30.0;
  double seconds = 8.0;
};

/// A clip of parametric human motion: +y up, facing about +z, centimetres, 21 joints, a root with
/// six channels, rotations in the order Z X Y (upper arms: Z Y X). Walking follows the normative
/// joint angles of gait analysis (Winter, Biomechanics and Motor Control of Human Movement), with
/// the root's travel and height taken from the planted foot by forward kinematics; the other
/// actions run on key poses. Body segments are fractions of stature (Drillis and Contini). A
/// planted foot does not slide, knees and elbows bend one way only, and the ground is y = 0. The
/// same options give the same clip on every platform, up to the rounding of its <cmath>.
/// @throws ConfigError if a number is out of range
Motion synthesize(const SynthesisOptions& options);

/// `walk_s01_02.bvh` for clip 2 of subject 1, so that a split by subject can be read off the name.
std::string synthesis_file_name(const SynthesisOptions& options);

}  // namespace mcdbn
