#include "motion_model/sample_calibration.hpp"

#include <algorithm>
#include <cmath>

#include "machines/answer_batches.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/regeneration.hpp"

namespace mcdbn {
namespace {

constexpr double kMost_s = 600.0;
/// Deviation of samples as a share of the answers' error. At 1 the best of ten samples of unseen
/// people is 2 mm worse than the single answer; at 0.5 it is better; samples differ as much as real
/// walks do at both.
constexpr double kShareOfError = 0.5;

/// Joints about the root at rest, file units. @return for each clip [frames x 3·joints]
std::vector<MatrixD> joints_about_root(const Modalities& modalities,
                                       const std::vector<MatrixF>& poses) {
  const PoseFeatures& features = modalities.pose_features;
  std::vector<MatrixD> result;
  result.reserve(poses.size());
  for (const MatrixF& pose : poses)
    result.push_back(joint_positions(
        features.decode(modalities.pose_scale.invert(pose), Eigen::Matrix3d::Identity(),
                        features.skeleton(), modalities.fps, MatrixD::Zero(pose.rows(), 3))));
  return result;
}

/// Σ distances of joints in `many` from where `single` has them, for each of the copies in `many`.
double distance(const std::vector<MatrixD>& many, const std::vector<MatrixD>& single) {
  const std::size_t copies = many.size() / single.size();
  double sum = 0;
  for (std::size_t i = 0; i < many.size(); ++i) {
    const MatrixD difference = many[i] - single[i / copies];
    for (Eigen::Index joint = 0; joint < difference.cols(); joint += 3)
      sum += difference.middleCols<3>(joint).rowwise().norm().sum();
  }
  return sum / static_cast<double>(copies);
}

/// Every so many clips, so that memory does not grow with the corpus: ten minutes are enough.
std::size_t every_of_ten_minutes(const std::vector<MatrixF>& clips, double fps) {
  const auto frames = static_cast<double>(total_frames(clips));
  return static_cast<std::size_t>(std::max(1.0, std::ceil(frames / (kMost_s * fps))));
}

/// Parts of clips that are answered together.
struct CalibrationBatch {
  std::vector<MatrixF> tracks;
  std::vector<MatrixD> answers;  ///< joints about the root
};

/// How far samples are from the answers, each batch's being drawn for itself.
double strayed(const Mcdbn& network, const Modalities& modalities,
               const std::vector<CalibrationBatch>& batches, RegenerationOptions options) {
  double sum = 0;
  for (const CalibrationBatch& batch : batches) {
    sum += distance(joints_about_root(modalities, regenerate(network, batch.tracks, options)),
                    batch.answers);
    ++options.seed;
  }
  return sum;
}

}  // namespace

SamplingRule calibrated_sampling(const Mcdbn& network, const Modalities& modalities,
                                 const std::vector<MatrixF>& tracks,
                                 const std::vector<MatrixF>& poses) {
  if (tracks.size() != poses.size())
    throw ShapeError("calibration: as many tracks as poses are wanted");
  // The distance is a mean over ten minutes' frames already; and a thirtieth of the scale is less
  // than samples differ by.
  constexpr std::size_t kSamples = 4, kHalvings = 6;
  RegenerationOptions options;
  std::vector<CalibrationBatch> batches;
  double wanted = 0;
  for (const AnswerBatch& parts :
       answer_batches(tracks, every_of_ten_minutes(tracks, modalities.fps),
                      kFramesInStep / static_cast<Eigen::Index>(kSamples))) {
    CalibrationBatch batch{rows_of(parts, tracks), {}};
    batch.answers = joints_about_root(modalities, regenerate(network, batch.tracks, options));
    wanted += kShareOfError *
              distance(batch.answers, joints_about_root(modalities, rows_of(parts, poses)));
    batches.push_back(std::move(batch));
  }
  options.samples = kSamples;
  options.temperature = 1.0;
  options.sampling = {.gibbs_steps = 0,
                      .mrbm_gibbs_steps = std::max<std::size_t>(network.mean_field_steps, 1),
                      .steady = true};
  double low = 0.0, high = 2.0;
  for (std::size_t i = 0; i < kHalvings; ++i) {
    options.sampling.scale = 0.5 * (low + high);
    (strayed(network, modalities, batches, options) > wanted ? high : low) = options.sampling.scale;
  }
  options.sampling.scale = 0.5 * (low + high);
  return options.sampling;
}

}  // namespace mcdbn
