#include "mcdbn/baselines/baseline.hpp"

#include "mcdbn/baselines/constant_pose.hpp"
#include "mcdbn/baselines/hold_last_frame.hpp"
#include "mcdbn/baselines/nearest_neighbour.hpp"
#include "mcdbn/baselines/ridge_window.hpp"

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
