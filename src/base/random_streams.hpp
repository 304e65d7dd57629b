#pragma once

#include <cstdint>

/// RandomKey::stream of everything that draws numbers from one seed: no two may share one, or they
/// would draw the same.
namespace mcdbn::random_streams {

/// Stream of a CDBN's first layer; each further layer has the next one. CDBN 0 is trained first.
/// Streams of two modalities lie before the MRBM's, those of further ones behind all others.
constexpr std::uint16_t layers_of(std::size_t cdbn) {
  return static_cast<std::uint16_t>(cdbn < 2 ? 64 * cdbn : 0x1000 + 64 * (cdbn - 2));
}
inline constexpr std::size_t kMostModalities = 64;  ///< so that layers_of ends before kPerceptron
inline constexpr std::uint16_t kMrbm = 128;
inline constexpr std::uint16_t kAugmentedViews = 192;
inline constexpr std::uint16_t kWindows = 193;  ///< which windows make a mini-batch
inline constexpr std::uint16_t kDropout = 194;  ///< of fine-tuning
inline constexpr std::uint16_t kFirstWeights = 195;
inline constexpr std::uint16_t kScalingViews =
    196;  ///< those that the features' scale is learnt from
inline constexpr std::uint16_t kDrawnPairs = 197;  ///< of a report
inline constexpr std::uint16_t kDecoder = 200;
inline constexpr std::uint16_t kMrbmChain = 201;
// Streams of tracks: augmented views' and evaluations'.
inline constexpr std::uint16_t kPixelNoise = 202;
inline constexpr std::uint16_t kMissingJoints = 203;
inline constexpr std::uint16_t kHiddenArm = 204;
inline constexpr std::uint16_t kHiddenLimbs = 205;
inline constexpr std::uint16_t kGeneration = 206;
inline constexpr std::uint16_t kDetector = 207;  ///< of each column of its track
inline constexpr std::uint16_t kDetectorSwaps = 208;
inline constexpr std::uint16_t kRandomCamera = 209;
inline constexpr std::uint16_t kOtherBody = 213;
inline constexpr std::uint16_t kNewPoses = 214;        ///< of augmented views
inline constexpr std::uint16_t kPosteriorDraws = 215;  ///< of the fit
inline constexpr std::uint16_t kFreshViews = 216;
// Streams of a single machine (machines/sampling.hpp, energy.hpp, partition.hpp).
inline constexpr std::uint16_t kChains = 210;
inline constexpr std::uint16_t kFlippedUnits = 211;
inline constexpr std::uint16_t kAnnealing = 212;
inline constexpr std::uint16_t kPerceptron = 0x4d4c;   ///< and the next for each layer's drop-out
inline constexpr std::uint16_t kAutoencoder = 0x4d60;  ///< and the next for each RBM
inline constexpr std::uint16_t kBoltzmannMachine = 0x4d70;

}  // namespace mcdbn::random_streams
