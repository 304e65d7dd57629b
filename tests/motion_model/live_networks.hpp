#pragma once

#include <algorithm>

#include "machines/two_modalities.hpp"
#include "mcdbn/features/modalities.hpp"
#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn::test {

inline constexpr int kLookAhead = 2;

/// Its answers are near the mean pose, from where the fit finds the track, and depend on what it
/// sees.
inline Mcdbn quiet_network(Device& device, const Modalities& modalities) {
  const auto layer = [](int visible, std::size_t hidden, std::size_t order, std::uint64_t seed) {
    const CrbmShape shape{static_cast<std::size_t>(visible), hidden, order, VisibleKind::gaussian};
    return CrbmParameters::random(shape, 0.03, {seed, 0, 0, 0});
  };
  const MrbmParameters mrbm = MrbmParameters::random(two_modalities(8, 7, 6), 1.5, {3, 0, 0, 0});
  Mcdbn network{std::vector<Cdbn>(2), Mrbm(device, mrbm), kLookAhead, 4};
  network.cdbns[0].layers.emplace_back(device,
                                       layer(modalities.track_scale.output_dimension(), 8, 2, 1));
  network.cdbns[1].layers.emplace_back(device,
                                       layer(modalities.pose_scale.output_dimension(), 7, 3, 2));
  return network;
}

/// Its answer is the mean pose but for the left forearm, which points one way where the feature
/// LeftHand x is above `threshold`, and the other way where it is below.
inline Mcdbn hand_network(Device& device, const Modalities& modalities, float threshold) {
  CrbmParameters seeing =
      CrbmParameters::zeros({static_cast<std::size_t>(modalities.track_scale.output_dimension()), 2,
                             1, VisibleKind::gaussian});
  const std::vector<std::string>& joints = modalities.track_features.joint_names();
  const auto hand = std::ranges::find(joints, "LeftHand") - joints.begin();
  seeing.W(2 * hand, 0) = 20;
  seeing.b(0, 0) = -20 * threshold;
  MrbmParameters joining = MrbmParameters::zeros(two_modalities(2, 2, 1));
  joining.W[0](0, 0) = joining.W[1](0, 0) = 10;
  joining.b(0, 0) = -10;
  joining.a[1](0, 0) = -5;
  CrbmParameters answering =
      CrbmParameters::zeros({static_cast<std::size_t>(modalities.pose_scale.output_dimension()), 2,
                             1, VisibleKind::gaussian});
  const std::vector<std::string> features = modalities.pose_features.feature_names();
  for (std::size_t i = 0; i < features.size(); ++i)
    if (features[i].starts_with("LeftForeArm_x_axis")) {
      const auto feature = static_cast<Eigen::Index>(i);
      answering.W(feature, 0) = 4;
      answering.a(0, feature) = -2;
    }
  Mcdbn network{std::vector<Cdbn>(2), Mrbm(device, joining), kLookAhead, 4};
  network.cdbns[0].layers.emplace_back(device, seeing);
  network.cdbns[1].layers.emplace_back(device, answering);
  return network;
}

}  // namespace mcdbn::test
