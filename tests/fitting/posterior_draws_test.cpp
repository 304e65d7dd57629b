// Draws of the posterior, against the covariance that the formulas of docs/concepts.md make, in
// dense matrices and with finite differences.

#include "fitting/posterior_draws.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>

#include "fitting/clip_windows.hpp"
#include "fitting/slow_process.hpp"

namespace posterior_draws_test {

using namespace mcdbn;

namespace {

constexpr double kNoise = 0.002, kTurn_rad = 0.1, kChildsTurn_rad = 0.2;
constexpr Eigen::Index kTurns = 3, kOfFrame = 3 * kTurns + 3;

/// Three orientations: one, one that hangs from it, and another that nothing shows. One joint,
/// which the first two move.
PosteriorClip clip_of(Eigen::Index frames, bool body_unknown) {
  PosteriorClip clip;
  clip.parents = {-1, 0, 0};
  clip.lengths = {0, 1, 2};
  clip.turn_deviation_rad = MatrixD::Constant(frames, kTurns, kTurn_rad);
  clip.turn_deviation_rad.col(1).setConstant(kChildsTurn_rad);
  clip.root = MatrixD::Zero(frames, 3);
  clip.root.col(2).setConstant(4);
  clip.travelled = clip.root;
  clip.planted = MatrixD::Zero(frames, 0);
  clip.frame_time_s = 1.0 / 30;
  clip.body_unknown = body_unknown;
  SeenJoint joint{{{0, {0, 0.5, 0}}, {1, {0.2, 0.3, 0.1}}}, {0, 0}, 0.5};
  joint.ray = Eigen::Vector2d(0.2, 0.8) / 4.1;  // where it is: no residual, no weight of a loss
  clip.seen.assign(static_cast<std::size_t>(frames), {joint});
  return clip;
}

/// All unknowns of a point in a row.
Eigen::VectorXd row_of(const PosteriorPoint& point) {
  const Eigen::Index frames = point.turns.rows();
  Eigen::VectorXd row(frames * kOfFrame + point.log_lengths.size());
  for (Eigen::Index t = 0; t < frames; ++t)
    row.segment(t * kOfFrame, kOfFrame) << point.turns.row(t).transpose(),
        point.shift.row(t).transpose();
  row.tail(point.log_lengths.size()) = point.log_lengths;
  return row;
}

PosteriorPoint point_of(const PosteriorClip& clip, const Eigen::VectorXd& row) {
  PosteriorPoint point = PosteriorPoint::zero(clip);
  for (Eigen::Index t = 0; t < clip.frames(); ++t) {
    point.turns.row(t) = row.segment(t * kOfFrame, 3 * kTurns).transpose();
    point.shift.row(t) = row.segment<3>(t * kOfFrame + 3 * kTurns).transpose();
  }
  point.log_lengths = row.tail(point.log_lengths.size());
  return point;
}

/// The inverse covariance, term by term. Without any term an unknown has a deviation of 10.
class Information {
 public:
  Information(const PosteriorClip& clip, const RayNoise& noise, const TrackFitSettings& settings)
      : clip_(clip),
        settings_(settings),
        size_(row_of(PosteriorPoint::zero(clip)).size()),
        matrix_(MatrixD::Identity(size_, size_) / 100) {
    for (Eigen::Index t = 0; t < clip.frames(); ++t) add_ray(t, noise);
    for (Eigen::Index t = 0; t < clip.frames(); ++t) add_prior(t);
    const double proportion = settings.bone_log_deviation;
    for (Eigen::Index i = clip.frames() * kOfFrame; i < size_ && clip.body_unknown; ++i)
      matrix_(i, i) += 1 / (proportion * proportion);
  }

  MatrixD covariance() const { return matrix_.inverse(); }

 private:
  void add(const Eigen::VectorXd& derivative, double deviation) {
    matrix_ += derivative * derivative.transpose() / (deviation * deviation);
  }

  void add_ray(Eigen::Index t, const RayNoise& noise) {
    constexpr double kStep = 1e-5;
    const double white = noise.white * noise.white, lasting = noise.lasting * noise.lasting;
    const double again = std::max(1.0, 2 * settings_.detector_noise_time_s / clip_.frame_time_s);
    const double confidence = clip_.seen[0][0].confidence;
    for (const int axis : {0, 1}) {
      const auto ray = [&](Eigen::Index unknown, double step) {
        Eigen::VectorXd row = Eigen::VectorXd::Zero(size_);
        row[unknown] = step;
        const Eigen::Vector3d place = place_of(clip_, point_of(clip_, row), t, 0);
        return place[axis] / place.z();
      };
      Eigen::VectorXd derivative = Eigen::VectorXd::Zero(size_);
      for (Eigen::Index i = 0; i < size_; ++i)
        if (i >= clip_.frames() * kOfFrame ? clip_.body_unknown : i / kOfFrame == t)
          derivative[i] = (ray(i, kStep) - ray(i, -kStep)) / (2 * kStep);
      add(derivative, std::sqrt((white + again * lasting) / confidence));
    }
  }

  void add_prior(Eigen::Index t) {
    const SlowProcess process(settings_.prior_error_time_s, clip_.frame_time_s);
    const bool inside = t > 0 && t + 1 < clip_.frames();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (Eigen::Index turn = 0; turn < kTurns; ++turn) {
        const double own = clip_.turn_deviation_rad(0, turn), parents = kTurn_rad;
        const double kappa = turn == 0 ? 0 : settings_.parent_correlation;
        const double deviation = std::sqrt(1 - kappa * kappa) * own;
        Eigen::VectorXd point = Eigen::VectorXd::Zero(size_), bend = point;
        const auto put = [&](Eigen::VectorXd& into, Eigen::Index frame, double factor) {
          into[frame * kOfFrame + 3 * turn + axis] += factor;
          if (turn > 0) into[frame * kOfFrame + axis] -= factor * kappa * own / parents;
        };
        put(point, t, 1);
        add(point, deviation / std::sqrt(process.value_weight));
        if (!inside) continue;
        for (const Eigen::Index step : {-1, 0, 1}) put(bend, t + step, step == 0 ? -2 : 1);
        add(bend, deviation / std::sqrt(process.curvature_weight));
      }
      if (!inside) continue;
      Eigen::VectorXd bend = Eigen::VectorXd::Zero(size_);
      for (const Eigen::Index step : {-1, 0, 1})
        bend[(t + step) * kOfFrame + 3 * kTurns + axis] = step == 0 ? -2 : 1;
      add(bend, clip_.root_m_s2 * clip_.frame_time_s * clip_.frame_time_s);
    }
  }

  const PosteriorClip& clip_;
  const TrackFitSettings& settings_;
  Eigen::Index size_;
  MatrixD matrix_;
};

/// [draws x unknowns], from the likeliest
MatrixD drawn(const PosteriorClip& clip, const TrackFitSettings& settings, std::size_t count,
              std::uint64_t seed = 3) {
  const PosteriorPoint likeliest = PosteriorPoint::zero(clip);
  const auto draws = posterior_draws(clip, {kNoise, 2 * kNoise}, settings, likeliest, count, seed);
  MatrixD rows(static_cast<Eigen::Index>(count), row_of(likeliest).size());
  for (std::size_t i = 0; i < count; ++i)
    rows.row(static_cast<Eigen::Index>(i)) = row_of(draws[i]).transpose();
  return rows;
}

MatrixD covariance_of(const MatrixD& draws) {
  return draws.transpose() * draws / static_cast<double>(draws.rows());
}

}  // namespace

TEST_CASE("posterior draws: their covariance is the posterior's, of every pair of unknowns") {
  constexpr std::size_t kDraws = 4000;
  for (const bool body_unknown : {false, true}) {
    CAPTURE(body_unknown);
    const PosteriorClip clip = clip_of(5, body_unknown);
    for (const double spread : {1.0, 1.5}) {
      TrackFitSettings settings;
      settings.draw_width_factor = spread;
      const MatrixD found = covariance_of(drawn(clip, settings, kDraws));
      Eigen::Index unknowns = found.rows();
      if (!body_unknown) unknowns -= 3;  // of lengths that are known nothing is drawn
      CHECK(found.bottomRightCorner(found.rows() - unknowns, found.rows() - unknowns).isZero());
      MatrixD wanted = MatrixD::Identity(unknowns, unknowns);
      {
        PosteriorClip known = clip;
        const Information information(known, {kNoise, 2 * kNoise}, settings);
        MatrixD all = information.covariance();
        wanted = spread * spread * all.topLeftCorner(unknowns, unknowns);
      }
      double worst = 0;
      for (Eigen::Index i = 0; i < unknowns; ++i)
        for (Eigen::Index j = 0; j < unknowns; ++j) {
          // Of normal draws' mean products.
          const double deviation =
              std::sqrt((wanted(i, i) * wanted(j, j) + wanted(i, j) * wanted(i, j)) / kDraws);
          worst = std::max(worst, std::abs(found(i, j) - wanted(i, j)) / deviation);
        }
      CHECK(worst < 5);
    }
  }
}

TEST_CASE("posterior draws: the same by the same seed, others by another, each for itself") {
  const PosteriorClip clip = clip_of(4, true);
  const MatrixD few = drawn(clip, {}, 3), more = drawn(clip, {}, 5);
  CHECK(few == more.topRows(3));
  CHECK(few.row(0) != few.row(1));
  CHECK(drawn(clip, {}, 3, 4).row(0) != few.row(0));
  // The second and third window have as many frames, and differ in nothing else.
  constexpr Eigen::Index kFrames = 960, kOwn = 2 * kAllFrames.overlap + 100;  // in no other window
  const std::vector<ClipWindow> windows = windows_of(kFrames);
  REQUIRE(windows.size() == 4);
  REQUIRE(windows[1].frames == windows[2].frames);
  const MatrixD one = drawn(clip_of(kFrames, false), {}, 1);
  const auto own_frame = [&](const ClipWindow& window) {
    return one.middleCols((window.first + kOwn) * kOfFrame, kOfFrame);
  };
  CHECK((own_frame(windows[1]) - own_frame(windows[2])).norm() > 0.01);
}

TEST_CASE("posterior draws: in a long clip frames of two windows deviate as others, of one body") {
  constexpr Eigen::Index kFrames = 400, kDraws = 300;
  const std::vector<ClipWindow> windows = windows_of(kFrames);
  REQUIRE(windows.size() == 2);
  const Eigen::Index both = windows[1].first + 10;  // and 40 frames on, in both windows
  REQUIRE(both + 40 < windows[0].end());
  const PosteriorClip clip = clip_of(kFrames, true);
  const MatrixD draws = drawn(clip, {}, kDraws);
  // Of the second orientation, all of those frames.
  const auto variance = [&](Eigen::Index first, Eigen::Index frames) {
    double sum = 0;
    for (Eigen::Index t = first; t < first + frames; ++t)
      sum += draws.middleCols(t * kOfFrame + 3, 3).squaredNorm();
    return sum / static_cast<double>(3 * frames * kDraws);
  };
  const double alone = variance(60, 100);
  CHECK(variance(both, 40) / alone == doctest::Approx(1).epsilon(0.05));
  CHECK(variance(340, 40) / alone == doctest::Approx(1).epsilon(0.05));
  // The longer the first bone, the lower the root, in both windows alike.
  const auto with_length = [&](Eigen::Index t) {
    const Eigen::VectorXd height = draws.col(t * kOfFrame + 3 * kTurns + 1),
                          length = draws.col(draws.cols() - 3);
    return height.dot(length) / (height.norm() * length.norm());
  };
  CHECK(with_length(100) < -0.15);
  CHECK(with_length(370) < -0.15);
}

TEST_CASE("posterior draws: a window that shows nobody does not determine the body") {
  constexpr Eigen::Index kFrames = 400, kDraws = 20;
  const std::vector<ClipWindow> windows = windows_of(kFrames);
  REQUIRE(windows.size() == 2);
  const auto until_hidden = [&](Eigen::Index frames) {
    PosteriorClip clip = clip_of(frames, true);
    for (Eigen::Index t = windows[1].first; t < frames; ++t)
      clip.seen[static_cast<std::size_t>(t)][0].confidence = 0;
    return clip;
  };
  const MatrixD whole = drawn(until_hidden(kFrames), {}, kDraws).rightCols(kTurns),
                alone = drawn(until_hidden(windows[0].frames), {}, kDraws).rightCols(kTurns);
  CHECK((whole - alone).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("posterior draws: what follows from the body is the same in frames of two windows") {
  constexpr Eigen::Index kFrames = 400, kDraws = 100;
  const std::vector<ClipWindow> windows = windows_of(kFrames);
  REQUIRE(windows.size() == 2);
  PosteriorClip clip = clip_of(kFrames, true);
  clip.turn_deviation_rad /= 100;  // so that it is nearly all
  const MatrixD draws = drawn(clip, {}, kDraws);
  const auto height_over_length = [&](Eigen::Index t) {
    const Eigen::VectorXd length = draws.col(draws.cols() - 3);
    return draws.col(t * kOfFrame + 3 * kTurns + 1).dot(length) / length.squaredNorm();
  };
  const double alone = height_over_length(60);
  CHECK(std::abs(alone) > 0.1);
  for (Eigen::Index t = windows[1].first + 5; t < windows[0].end(); t += 10)
    CHECK(std::abs(height_over_length(t) / alone - 1) < 0.15);
}

}  // namespace posterior_draws_test
