#include "fitting/window_problem.hpp"

#include <ceres/crs_matrix.h>
#include <ceres/loss_function.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "fitting/camera_angles.hpp"
#include "fitting/free_axes.hpp"
#include "fitting/robust_residuals.hpp"
#include "fitting/terms/camera_lean.hpp"
#include "fitting/terms/ground_contact.hpp"
#include "fitting/terms/linear_term.hpp"
#include "fitting/terms/normal_term.hpp"
#include "fitting/terms/reprojection.hpp"
#include "fitting/terms/standing_foot.hpp"

namespace mcdbn {
namespace {

/// A joint that is nearer to the camera than this share of the root's first depth is seen as
/// Reprojection has it.
constexpr double kNearest = 0.1;
/// Least depth, for a root that the path before the fit puts next to the camera.
constexpr double kNearest_m = 0.01;
/// Below this confidence a standing foot adds no term.
constexpr double kLeastPlanted = 0.05;
/// Cauchy scale of the balance, in deviations: on hands and feet nobody is above the feet.
constexpr double kUnbalanced = 2;
/// Huber threshold of a slipping foot, in deviations.
constexpr double kSlips = 2;

ceres::LossFunction* scaled(ceres::LossFunction* loss, double weight) {
  return new ceres::ScaledLoss(loss, weight, ceres::TAKE_OWNERSHIP);
}

/// Ceres looks for each block that is added whether it overlaps others; ours are rows of matrices.
ceres::Problem::Options unchecked() {
  ceres::Problem::Options options;
  options.disable_all_safety_checks = true;
  return options;
}

template <typename Block>
void append(std::vector<Block>& to, const std::type_identity_t<std::vector<Block>>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

WindowProblem::WindowProblem(const PosteriorClip& clip, const RayNoise& noise,
                             const TrackFitSettings& settings, const PosteriorPoint& from,
                             Eigen::Index first, Eigen::Index frames, Unknowns unknowns)
    : clip_(clip),
      settings_(settings),
      noise_(noise),
      prior_(clip, noise, settings),
      first_(first),
      turns_(static_cast<int>(clip.parents.size())),
      x_{MatrixD(frames, from.turns.cols()), MatrixD(frames, 3), from.log_lengths, from.ground_m},
      problem_(unchecked()) {
  start_from(from);
  find_used(unknowns);
  add_rays();
  add_turns();
  add_root();
  add_feet();
  add_ground();
  if (clip_.camera) add_camera();
  if (clip_.body_unknown) add_lengths(unknowns);
  if (clip_.past) add_past();
}

void WindowProblem::start_from(const PosteriorPoint& from) {
  x_.turns = from.turns.middleRows(first_, x_.turns.rows());
  x_.shift = from.shift.middleRows(first_, x_.shift.rows());
  x_.take_shared(from);
}

double WindowProblem::energy() {
  double energy = 0;
  problem_.Evaluate({}, &energy, nullptr, nullptr, nullptr);
  return energy;
}

Eigen::SparseMatrix<double> WindowProblem::derivatives() {
  ceres::Problem::EvaluateOptions options;
  std::vector<Eigen::Index> columns;  // by column of Ceres', ours
  Eigen::Index column = 0;
  const auto take = [&](double* block, Eigen::Index size) {
    if (problem_.HasParameterBlock(block)) {
      options.parameter_blocks.push_back(block);
      for (Eigen::Index i = 0; i < size; ++i) columns.push_back(column + i);
    }
    column += size;
  };
  for (Eigen::Index t = 0; t < x_.turns.rows(); ++t) {
    for (int turn = 0; turn < turns_; ++turn) take(turn_at(t, turn), 3);
    take(shift_at(t), 3);
  }
  for (double& length : x_.log_lengths) take(&length, 1);
  ceres::CRSMatrix found;
  problem_.Evaluate(options, nullptr, nullptr, nullptr, &found);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(found.values.size());
  for (int row = 0; row < found.num_rows; ++row)
    for (int i = found.rows[static_cast<std::size_t>(row)];
         i < found.rows[static_cast<std::size_t>(row) + 1]; ++i) {
      const auto at = static_cast<std::size_t>(i);
      entries.emplace_back(row, columns[static_cast<std::size_t>(found.cols[at])],
                           found.values[at]);
    }
  Eigen::SparseMatrix<double> result(found.num_rows, column);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// @param first frame that it depends on; whether a foot stands depends on the frame before, too
void WindowProblem::add(Eigen::Index first, ceres::CostFunction* cost, ceres::LossFunction* loss,
                        const std::vector<double*>& blocks) {
  terms_.emplace_back(problem_.AddResidualBlock(cost, loss, blocks), first);
}

const std::vector<SeenJoint>& WindowProblem::seen(Eigen::Index t) const {
  return clip_.seen[static_cast<std::size_t>(first_ + t)];
}

void WindowProblem::find_used(Unknowns unknowns) {
  used_.assign(clip_.parents.size(), unknowns == Unknowns::all);
  const auto use = [&](const SeenJoint& joint) {
    for (const Lever& lever : joint.levers) used_[static_cast<std::size_t>(lever.turn)] = true;
  };
  for (Eigen::Index t = 0; t < x_.turns.rows(); ++t)
    for (const SeenJoint& joint : seen(t))
      if (unknowns == Unknowns::tracked || joint.confidence > 0) use(joint);
  for (std::size_t turn = used_.size(); turn-- > 0;)
    if (used_[turn] && clip_.parents[turn] >= 0)
      used_[static_cast<std::size_t>(clip_.parents[turn])] = true;
}

/// Whether what moves the joint is among the unknowns.
bool WindowProblem::is_used(std::size_t joint) const {
  return std::ranges::all_of(seen(0)[joint].levers, [&](const Lever& lever) {
    return used_[static_cast<std::size_t>(lever.turn)];
  });
}

JointPlace WindowProblem::place(Eigen::Index t, std::size_t joint) const {
  return {seen(t)[joint].levers, clip_.root.row(first_ + t).transpose(), clip_.body_unknown};
}

std::vector<double*> WindowProblem::moving_blocks(Eigen::Index t, std::size_t joint) {
  std::vector<double*> blocks;
  for (const Lever& lever : seen(t)[joint].levers) blocks.push_back(turn_at(t, lever.turn));
  blocks.push_back(shift_at(t));
  return blocks;
}

std::vector<double*> WindowProblem::length_blocks(std::size_t joint) {
  std::vector<double*> blocks;
  if (!clip_.body_unknown) return blocks;
  for (const Lever& lever : seen(0)[joint].levers)
    blocks.push_back(&x_.log_lengths[clip_.lengths[static_cast<std::size_t>(lever.turn)]]);
  return blocks;
}

/// Noise that lasts is the same in frame after frame, so that its energy is a rate over time.
void WindowProblem::add_rays() {
  const double same_frames =
      std::max(1.0, 2 * settings_.detector_noise_time_s / clip_.frame_time_s);
  const double lasting = noise_.lasting * noise_.lasting, white = noise_.white * noise_.white;
  const double weight = (white + lasting) / (white + same_frames * lasting);
  for (Eigen::Index t = 0; t < x_.turns.rows(); ++t) {
    const double nearest_m = std::max(kNearest * std::abs(clip_.root(first_ + t, 2)), kNearest_m);
    for (std::size_t joint = 0; joint < seen(t).size(); ++joint) {
      const SeenJoint& at = seen(t)[joint];
      if (!(at.confidence > 0)) continue;
      std::vector<double*> blocks = moving_blocks(t, joint);
      append(blocks, length_blocks(joint));
      if (clip_.camera) blocks.push_back(&x_.log_focal);
      add(t,
          new Reprojection(place(t, joint), nearest_m, at.ray,
                           std::sqrt((white + lasting) / at.confidence), clip_.camera.has_value()),
          scaled(new ceres::CauchyLoss(settings_.outlier_deviations), weight), blocks);
    }
  }
}

/// An orientation's difference from what its parent predicts is a slow process about zero.
void WindowProblem::add_turns() {
  const SlowProcess& process = prior_.process();
  for (int turn = 0; turn < turns_; ++turn) {
    if (!used_[static_cast<std::size_t>(turn)]) continue;
    const int parent = clip_.parents[static_cast<std::size_t>(turn)];
    for (Eigen::Index t = 0; t < x_.turns.rows(); ++t) {
      const double deviation = prior_.own_deviation_rad(first_ + t, turn);
      const double share = prior_.share_of_parent(first_ + t, turn);
      std::vector<double*> blocks{turn_at(t, turn)};
      std::vector<double> shares{1};
      if (parent >= 0) {
        blocks.push_back(turn_at(t, parent));
        shares.push_back(-share);
      }
      if (clip_.camera) {
        blocks.push_back(x_.lean.data());
        shares.push_back(share - 1);
      }
      add(t,
          new LinearTerm(shares, prior_.expected_turn_at_rest(first_ + t, turn),
                         deviation / std::sqrt(process.value_weight)),
          nullptr, blocks);
      if (t == 0 || t + 1 == x_.turns.rows()) continue;
      blocks = {turn_at(t - 1, turn), turn_at(t, turn), turn_at(t + 1, turn)};
      shares = {1, -2, 1};
      if (parent >= 0) {
        append(blocks, {turn_at(t - 1, parent), turn_at(t, parent), turn_at(t + 1, parent)});
        for (const double step : {1, -2, 1}) shares.push_back(-step * share);
      }
      add(t - 1,
          new LinearTerm(shares, prior_.expected_bend_at_rest(first_ + t, turn),
                         deviation / std::sqrt(process.curvature_weight)),
          nullptr, blocks);
    }
  }
}

/// The root's acceleration is the prior's, up to a deviation of root_m_s2.
void WindowProblem::add_root() {
  const double bend_m = clip_.root_m_s2 * clip_.frame_time_s * clip_.frame_time_s;
  for (Eigen::Index t = 1; t + 1 < x_.turns.rows(); ++t) {
    const MatrixD travel_error =
        clip_.travelled.middleRows(first_ + t - 1, 3) - clip_.root.middleRows(first_ + t - 1, 3);
    const Eigen::Vector3d wanted =
        travel_error.row(0) - 2 * travel_error.row(1) + travel_error.row(2);
    add(t - 1, new LinearTerm({1, -2, 1}, wanted, bend_m), nullptr,
        {shift_at(t - 1), shift_at(t), shift_at(t + 1)});
  }
}

void WindowProblem::add_feet() {
  for (std::size_t f = 0; f < clip_.feet.size(); ++f) {
    const std::size_t foot = clip_.feet[f];
    if (!is_used(foot)) continue;
    for (Eigen::Index t = 1; t < x_.turns.rows(); ++t) {
      const double confidence = clip_.planted(first_ + t, static_cast<Eigen::Index>(f));
      if (confidence < kLeastPlanted) continue;
      std::vector<double*> blocks = moving_blocks(t - 1, foot);
      append(blocks, moving_blocks(t, foot));
      append(blocks, length_blocks(foot));
      const double deviation_m =
          settings_.planted_foot_speed_m_s * clip_.frame_time_s / std::sqrt(confidence);
      add(t - 1, new StandingFoot(place(t - 1, foot), place(t, foot), deviation_m),
          new ceres::HuberLoss(kSlips), blocks);
    }
  }
}

/// Heights of standing feet within about a step count as one observation.
void WindowProblem::add_ground() {
  const double weight = std::min(1.0, clip_.frame_time_s / settings_.ground_observation_s);
  for (std::size_t f = 0; f < clip_.feet.size(); ++f) {
    const std::size_t foot = clip_.feet[f];
    if (!is_used(foot)) continue;
    double* const height = &x_.ground_m[clip_.grounds[f]];
    for (Eigen::Index t = 1; t < x_.turns.rows(); ++t) {
      const double confidence = clip_.planted(first_ + t, static_cast<Eigen::Index>(f));
      if (confidence < kLeastPlanted) continue;
      std::vector<double*> blocks = moving_blocks(t, foot);
      append(blocks, length_blocks(foot));
      blocks.push_back(height);
      if (clip_.camera) blocks.push_back(x_.lean.data());
      add(t - 1,
          new GroundContact(place(t, foot), clip_.up, settings_.ground_deviation_m,
                            clip_.camera.has_value()),
          scaled(new ceres::CauchyLoss(kCauchy), confidence * weight), blocks);
    }
  }
}

void WindowProblem::add_camera() {
  const UnknownCamera& camera = *clip_.camera;
  const Eigen::Vector3d right = level_right(clip_.up);
  problem_.AddParameterBlock(x_.lean.data(), 3);
  Eigen::Matrix3Xd free(3, 0);
  const auto set_free = [&](const Eigen::Vector3d& axis) {
    free.conservativeResize(3, free.cols() + 1);
    free.rightCols<1>() = axis;
  };
  if (!camera.pitch_known) set_free(right);
  if (!camera.roll_known) set_free(Eigen::Vector3d::UnitZ());
  if (free.cols() == 0)
    problem_.SetParameterBlockConstant(x_.lean.data());
  else
    problem_.SetManifold(x_.lean.data(), new FreeAxes(std::move(free)));
  problem_.AddResidualBlock(new CameraLean(camera.usual, right), nullptr, x_.lean.data());
  problem_.AddResidualBlock(new CameraLean(camera.balanced, right),
                            new ceres::CauchyLoss(kUnbalanced), x_.lean.data());
  problem_.AddResidualBlock(new LinearTerm({1}, Eigen::VectorXd::Constant(1, camera.log_focal),
                                           camera.log_focal_deviation),
                            nullptr, &x_.log_focal);
  if (camera.focal_known) problem_.SetParameterBlockConstant(&x_.log_focal);
}

std::vector<UnknownBlock> WindowProblem::shared_blocks() {
  std::vector<UnknownBlock> blocks;
  if (clip_.body_unknown)
    for (double& length : x_.log_lengths) blocks.push_back({&length, 1});
  for (double& height : x_.ground_m) blocks.push_back({&height, 1});
  if (clip_.camera) append(blocks, {{x_.lean.data(), 3}, {&x_.log_focal, 1}});
  return blocks;
}

Eigen::Index WindowProblem::numbers_of_frame() const {
  return 3 * std::ranges::count(used_, true) + 3;
}

std::vector<UnknownBlock> WindowProblem::blocks_of_frames(Eigen::Index first, Eigen::Index count) {
  std::vector<UnknownBlock> blocks;
  for (Eigen::Index t = first; t < first + count; ++t) {
    for (int turn = 0; turn < turns_; ++turn)
      if (used_[static_cast<std::size_t>(turn)]) blocks.push_back({turn_at(t, turn), 3});
    blocks.push_back({shift_at(t), 3});
  }
  return blocks;
}

void WindowProblem::add_past() {
  std::vector<double*> unknowns;
  std::vector<int> sizes;
  for (const UnknownBlock& block : blocks_of_frames(0, MarginalPrior::kReach)) {
    unknowns.push_back(block.unknown);
    sizes.push_back(block.size);
  }
  const MarginalPrior& past = *clip_.past;
  Eigen::VectorXd at = past.at;
  for (Eigen::Index t = 0; t < MarginalPrior::kReach; ++t)
    at.segment<3>((t + 1) * numbers_of_frame() - 3) -= clip_.root.row(first_ + t).transpose();
  add(0, new NormalTerm(past.factor, std::move(at), past.residual, sizes), nullptr, unknowns);
}

MarginalPrior WindowProblem::without_first(Eigen::Index frames) {
  QuadraticEnergy energy(blocks_of_frames(0, frames + MarginalPrior::kReach));
  for (const auto& [term, first] : terms_)
    if (first < frames) energy.add(problem_, term);
  const Eigen::Index of_frame = numbers_of_frame();
  MarginalPrior past = energy.without_first(frames * of_frame);
  for (Eigen::Index t = 0; t < MarginalPrior::kReach; ++t)
    past.at.segment<3>((t + 1) * of_frame - 3) += clip_.root.row(first_ + frames + t).transpose();
  return past;
}

/// Whether the body has legs, and no frame shows a joint that a thigh or a shank moves. Lengths of
/// hidden legs may be unknowns all the same: those of feet that stand.
bool WindowProblem::hides_legs() const {
  const auto is_of_leg = [&](int length) {
    return static_cast<std::size_t>(length) < clip_.length_kinds.size() &&
           clip_.length_kinds[static_cast<std::size_t>(length)] == BoneKind::leg;
  };
  const auto shows_a_leg = [&](const SeenJoint& joint) {
    return joint.confidence > 0 && std::ranges::any_of(joint.levers, [&](const Lever& lever) {
             return is_of_leg(clip_.lengths[static_cast<std::size_t>(lever.turn)]);
           });
  };
  if (std::ranges::none_of(clip_.lengths, is_of_leg)) return false;
  for (Eigen::Index t = 0; t < x_.turns.rows(); ++t)
    if (std::ranges::any_of(seen(t), shows_a_leg)) return false;
  return true;
}

/// One camera does not distinguish a small person from one far away: a person's size is that of the
/// legs, and where they are hidden, of what is seen.
double WindowProblem::proportion_deviation(std::size_t length, bool legs_hidden) const {
  if (legs_hidden) return settings_.partial_body_log_deviation;
  if (length >= clip_.length_kinds.size()) return settings_.bone_log_deviation;
  switch (clip_.length_kinds[length]) {
    case BoneKind::leg:
      return settings_.leg_log_deviation;
    case BoneKind::arm:
      return settings_.arm_log_deviation;
    case BoneKind::other:
      break;
  }
  return settings_.bone_log_deviation;
}

void WindowProblem::add_lengths(Unknowns unknowns) {
  const bool legs_hidden = hides_legs();
  for (std::size_t i = 0; i < static_cast<std::size_t>(x_.log_lengths.size()); ++i) {
    double& length = x_.log_lengths[static_cast<Eigen::Index>(i)];
    if (unknowns != Unknowns::seen || problem_.HasParameterBlock(&length))
      problem_.AddResidualBlock(
          new LinearTerm({1}, Eigen::VectorXd::Zero(1), proportion_deviation(i, legs_hidden)),
          nullptr, &length);
  }
}

}  // namespace mcdbn
