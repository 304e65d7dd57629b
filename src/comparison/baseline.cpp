#include "comparison/baseline.hpp"

#include "comparison/constant_pose.hpp"
#include "comparison/hold_last_frame.hpp"
#include "comparison/nearest_neighbour.hpp"
#include "comparison/ridge_window.hpp"

namespace mcdbn {

std::vector<std::unique_ptr<Baseline>> default_baselines() {
  std::vector<std::unique_ptr<Baseline>> baselines;
  baselines.push_back(std::make_unique<ConstantPose>());
  baselines.push_back(std::make_unique<HoldLastFrame>());
  baselines.push_back(std::make_unique<NearestNeighbour>());
  baselines.push_back(std::make_unique<RidgeWindow>());
  return baselines;
}

}  // namespace mcdbn
