#pragma once

#include <cstddef>
#include <cstdint>

/// RandomKey::phase: which draws of a stream and a step. All of them, apart from those of streams
/// that number their few draws from 0 themselves:
///
///     0 …         Gibbs steps, one phase each or one for each kind of units; drop-out, one for
///                 each layer
///     0x0100 …    drop-out of fine-tuning's second direction, and so on
///     0x1000 …    visible units that the chains of a learning rule draw; hidden ones are from 0 on
///     … 0x3fff    an MRBM's clamped chain, which then goes on with a further step
///     0x7000      the order of the windows in an epoch
///     0x7100 …    first weights: a CRBM's W, A and B take the three phases that follow
///     0x7200      noise on histories
///     0x8000 …    the second number of a Gaussian draw: the first one's phase with this bit
namespace mcdbn::random_phases {

inline constexpr std::uint16_t kVisibleUnits = 0x1000;
inline constexpr std::uint16_t kShuffle = 0x7000;
inline constexpr std::uint16_t kFirstWeights = 0x7100;
inline constexpr std::uint16_t kHistoryNoise = 0x7200;
inline constexpr std::uint16_t kSecondUniform = 0x8000;

/// How many phases a direction of fine-tuning, and a step of a clamped chain, may take.
inline constexpr std::uint16_t kPhasesOfDirection = 0x100;
inline constexpr std::size_t kPhasesOfChain = 0x4000;

}  // namespace mcdbn::random_phases
