#include "mcdbn/corpus/augmentation.hpp"

#include <doctest/doctest.h>

#include "corpus/no_augmentation.hpp"
#include "mcdbn/synthesis/synthesize.hpp"
#include "motion/body_size.hpp"
#include "motion/resample.hpp"

namespace augmentation_test {

using namespace mcdbn;
using test::nothing;

namespace {

Motion walk() {
  SynthesisOptions options;
  options.fps = 120.0;
  options.seconds = 3.0;
  return synthesize(options);
}

constexpr RandomKey kKey{3, 1, 0, 0};

double largest_difference(const MatrixD& x, const MatrixD& y) {
  return (x - y).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a view is the same for the same key, and another for another") {
  const Motion raw = walk();
  const auto view = [&](const RandomKey& key) {
    AugmentationSettings settings;
    settings.missing = 0;
    return augmented_view(raw, 30.0, {}, settings, key);
  };
  RandomKey other = kKey;
  other.step = 2;
  const AugmentedView first = view(kKey);
  CHECK(first.motion.channels == view(kKey).motion.channels);
  CHECK(first.track.x_px == view(kKey).track.x_px);
  const MatrixD ours = first.motion.channels, others = view(other).motion.channels;
  CHECK((ours.rows() != others.rows() || ours != others));
}

TEST_CASE("without settings a view is the clip itself, at another phase") {
  const Motion raw = walk();
  const AugmentedView view = augmented_view(raw, 30.0, {}, nothing(), kKey);
  const Motion plain = resample(raw, 30.0);
  CHECK(view.motion.fps() == doctest::Approx(30.0));
  CHECK(std::abs(view.motion.frames() - plain.frames()) <= 1);
  CHECK(file_units_per_metre(view.motion.skeleton) == file_units_per_metre(raw.skeleton));
  // Within a frame's step of the clip.
  const MatrixD positions = joint_positions(plain), seen = joint_positions(view.motion);
  const Eigen::Index frames = std::min(positions.rows(), seen.rows()) - 1;
  const double step =
      largest_difference(positions.topRows(frames), positions.middleRows(1, frames));
  CHECK(largest_difference(positions.topRows(frames), seen.topRows(frames)) <= step);
}

TEST_CASE("a track shows the motion beside it, with the noise that was asked for") {
  AugmentationSettings settings;
  settings.noise_px = settings.missing = 0;
  const AugmentedView clean = augmented_view(walk(), 30.0, {}, settings, kKey);
  CHECK(largest_difference(clean.track.x_px, project_motion(clean.motion, clean.camera).x_px) <
        1e-9);
  settings.noise_px = 1.0;
  const AugmentedView noisy = augmented_view(walk(), 30.0, {}, settings, kKey);
  const MatrixD noise = noisy.track.x_px - clean.track.x_px;
  CHECK(noise.cwiseAbs().maxCoeff() > 0);
  CHECK(std::sqrt(noise.array().square().mean()) < 4.0);  // twice the mean, for a larger figure
}

TEST_CASE("limbs are hidden in the share of the views that was asked for") {
  const Motion raw = walk();
  AugmentationSettings settings = nothing();
  settings.missing = 0.5;
  int gappy = 0;
  constexpr int kViews = 60;
  for (std::uint32_t i = 0; i < kViews; ++i) {
    const AugmentedView view = augmented_view(raw, 30.0, {}, settings, {3, i, 0, 0});
    gappy += view.track.x_px.array().isNaN().any();
  }
  // Five deviations of the binomial distribution.
  CHECK(std::abs(gappy - kViews / 2) < 5 * std::sqrt(kViews / 4.0));
}

TEST_CASE("bones of both sides change alike") {
  AugmentationSettings settings = nothing();
  settings.bone = 0.1;
  const Motion raw = walk();
  const AugmentedView view = augmented_view(raw, 30.0, {}, settings, kKey);
  int changed = 0;
  for (const Joint& joint : view.motion.skeleton.joints) {
    const std::size_t left = joint.name.find("Left");
    if (left == std::string::npos) continue;
    std::string name = joint.name;
    const int right = view.motion.skeleton.find(name.replace(left, 4, "Right"));
    REQUIRE(right >= 0);
    const Joint& other = view.motion.skeleton.joints[right];
    CHECK(joint.offset.norm() == doctest::Approx(other.offset.norm()).epsilon(1e-9));
    changed += std::abs(joint.offset.norm() -
                        raw.skeleton.joints[raw.skeleton.find(joint.name)].offset.norm()) > 1e-6;
  }
  CHECK(changed > 0);
  // In units of its own size the figure stands and walks as it did.
  AugmentationSettings same = settings;
  same.bone = 0;
  const Motion unchanged = augmented_view(raw, 30.0, {}, same, kKey).motion;
  const double size = body_height(view.motion.skeleton) / body_height(raw.skeleton);
  CHECK(std::abs(size - 1.0) > 1e-3);
  CHECK(largest_difference(view.motion.channels.leftCols(3),
                           size * unchanged.channels.leftCols(3)) < 1e-9);
}

}  // namespace augmentation_test
