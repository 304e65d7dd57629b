#include "fitting/terms/standing_foot.hpp"

#include <utility>
#include <vector>

namespace mcdbn {

StandingFoot::StandingFoot(JointPlace before, JointPlace after, double deviation_m)
    : before_(std::move(before)), after_(std::move(after)), deviation_m_(deviation_m) {
  set_num_residuals(3);
  const std::vector<int> sizes = before_.block_sizes();
  const auto lengths = sizes.begin() + moving_blocks();
  std::vector<int32_t>& all = *mutable_parameter_block_sizes();
  all.assign(sizes.begin(), lengths);
  all.insert(all.end(), sizes.begin(), sizes.end());
}

int StandingFoot::moving_blocks() const {
  return before_.levers() + 1;
}

bool StandingFoot::Evaluate(double const* const* unknowns, double* residuals,
                            double** jacobians) const {
  const int moving = moving_blocks(), lengths = before_.blocks() - moving;
  double const* const* const after = unknowns + moving;
  std::vector<double const*> before(unknowns, unknowns + moving);
  before.insert(before.end(), after + moving, after + moving + lengths);
  Eigen::Map<Eigen::Vector3d>{residuals} =
      (after_.at(after) - before_.at(before.data())) / deviation_m_;
  if (!jacobians) return true;
  const Eigen::Matrix3d of_place = Eigen::Matrix3d::Identity() / deviation_m_;
  after_.differentiate<3>(of_place, after, jacobians + moving);
  // Both frames' share of a length is summed.
  std::vector<Eigen::Vector3d> of_lengths(static_cast<std::size_t>(lengths));
  std::vector<double*> into(jacobians, jacobians + moving);
  for (Eigen::Vector3d& of_length : of_lengths) into.push_back(of_length.data());
  before_.differentiate<3>(-of_place, before.data(), into.data());
  for (int i = 0; i < lengths; ++i)
    if (double* const of_length = jacobians[2 * moving + i])
      Eigen::Map<Eigen::Vector3d>{of_length} += of_lengths[static_cast<std::size_t>(i)];
  return true;
}

}  // namespace mcdbn
