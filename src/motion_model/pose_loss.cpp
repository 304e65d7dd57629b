#include "motion_model/pose_loss.hpp"

#include <algorithm>

#include "device/kernel_arguments.hpp"
#include "device/opencl_errors.hpp"
#include "device/pointwise.hpp"
#include "device/training_state.hpp"
#include "features/pose_bones.hpp"
#include "learning/squared_loss.hpp"
#include "motion/foot_joints.hpp"

namespace mcdbn {
namespace {

template <typename T>
cl::Buffer constant_table(Device& device, std::vector<T> values) {
  if (values.empty()) values.resize(1);
  return checked(device.info().name, "writing a table", [&] {
    return cl::Buffer(device.context(), CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                      values.size() * sizeof(T), values.data());
  });
}

}  // namespace

PoseLoss::PoseLoss(Device& device, const Modalities& modalities, const SequenceWindows& windows,
                   const PoseLossWeights& weights)
    : windows_(windows),
      weights_(weights),
      dimension_(static_cast<std::size_t>(modalities.pose_scale.output_dimension())),
      velocity_feature_(modalities.pose_features.velocity_feature()),
      frame_s_(1.0 / modalities.fps) {
  const std::vector<int> feet = foot_joints(modalities.pose_features.skeleton());
  const auto bones = pose_bones(modalities.pose_features);
  bones_ = bones.size();
  std::vector<cl_int4> table;
  std::vector<cl_float4> levers;
  for (const PoseBone& bone : bones) {
    const bool foot = std::find(feet.begin(), feet.end(), bone.joint) != feet.end();
    feet_ += foot ? 1 : 0;
    table.push_back({{bone.parent, bone.block, foot ? 1 : 0,
                      modalities.pose_features.leading_axis(bone.block)}});
    const Eigen::Vector3f lever = bone.lever_m.cast<float>();
    levers.push_back({{lever.x(), lever.y(), lever.z(), 0.0F}});
  }
  const Standardizer& standardizer = modalities.pose_scale;
  std::vector<cl_int> columns(static_cast<std::size_t>(standardizer.input_dimension()), -1);
  std::vector<cl_float2> scale;
  scale.reserve(columns.size());
  for (std::size_t k = 0; k < standardizer.kept_columns().size(); ++k)
    columns[static_cast<std::size_t>(standardizer.kept_columns()[k])] = to_int(k);
  for (int i = 0; i < standardizer.input_dimension(); ++i)
    scale.push_back({{static_cast<float>(standardizer.mean()[i]),
                      static_cast<float>(standardizer.deviation()[i])}});
  bone_table_ = constant_table(device, table);
  levers_ = constant_table(device, levers);
  columns_ = constant_table(device, columns);
  scale_ = constant_table(device, scale);
  differences_ = Matrix(device, windows.rows(), std::max<std::size_t>(3 * bones_, 1));
  losses_ = Matrix(device, windows.rows(), 4);
  sums_ = Matrix(device, 1, 4);
}

void PoseLoss::differentiate(const Matrix& prediction, const Matrix& target, Matrix& error) {
  require_windows(windows_, prediction, target, error);
  require(prediction.columns() == dimension_, "pose loss: not the 3D modality");
  Device& device = error.device();
  const Defines defines{{"DIMENSION", to_int(dimension_)},
                        {"LD", to_int(padded(dimension_))},
                        {"BONES", to_int(std::max<std::size_t>(bones_, 1))},
                        {"FEET", to_int(std::max<std::size_t>(feet_, 1))},
                        {"VELOCITY", velocity_feature_}};
  const LaunchSize size{{windows_.rows(), 1}};
  const int frames = to_int(windows_.frames), judged_from = to_int(windows_.judged_from);
  launch(device, device.programs().kernel("kinematic_loss.cl", "position_differences", defines),
         size, prediction.buffer(), target.buffer(), differences_.buffer(),
         to_int(differences_.stride()), frames, judged_from, bone_table_, levers_, columns_,
         scale_);
  const cl_float4 weights{{static_cast<float>(weights_.features),
                           static_cast<float>(weights_.positions / (kPosition_m * kPosition_m)),
                           static_cast<float>(weights_.velocities / (kStep_m * kStep_m)),
                           static_cast<float>(weights_.contacts / (kStep_m * kStep_m))}};
  launch(device, device.programs().kernel("kinematic_loss.cl", "pose_errors", defines), size,
         prediction.buffer(), target.buffer(), differences_.buffer(), to_int(differences_.stride()),
         to_int(windows_.count), frames, judged_from, weights, static_cast<float>(frame_s_),
         static_cast<float>(frame_s_ * weights_.planted_below_m_s), bone_table_, levers_, columns_,
         scale_, error.buffer(), losses_.buffer(), to_int(losses_.stride()));
  column_sum(losses_, 1.0F, 1.0F, sums_);
  ++steps_;
}

void PoseLoss::visit_state(TrainingState& state) {
  state.matrix("pose_loss", sums_);
  state.number("pose_loss.steps", steps_);
}

double PoseLoss::read_and_reset() {
  const MatrixD means = sums_.to_host().cast<double>() / static_cast<double>(std::max(steps_, 1UL));
  sums_.set_zero();
  steps_ = 0;
  return weights_.features * means(0) +
         weights_.positions * means(1) / (kPosition_m * kPosition_m) +
         (weights_.velocities * means(2) + weights_.contacts * means(3)) / (kStep_m * kStep_m);
}

}  // namespace mcdbn
