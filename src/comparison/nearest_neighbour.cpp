#include "comparison/nearest_neighbour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/missing_values.hpp"
#include "comparison/clip_pairs.hpp"
#include "mcdbn/features/standardizer.hpp"

namespace mcdbn {
namespace {

/// Training and track rows whose products are held at a time.
constexpr Eigen::Index kTrainingBlock = 2048;
constexpr Eigen::Index kTrackBlock = 256;

/// Best match so far of one frame of the track.
struct Match {
  Eigen::Index row = 0;
  double square = std::numeric_limits<double>::infinity();
  float preselected = std::numeric_limits<float>::infinity();
};

/// Looks through one block of training rows, the first of which is row `base`.
/// @param half_distance [1 x block rows], half the squared distance but for the query's own square
void update(Match& match, const Eigen::Ref<const RowVectorF>& query,
            const Eigen::Ref<const RowVectorF>& half_distance, float slack,
            const Eigen::Ref<const MatrixF>& block, Eigen::Index base) {
  match.preselected = std::min(match.preselected, half_distance.minCoeff());
  for (Eigen::Index j = 0; j < block.rows(); ++j) {
    if (half_distance(j) > match.preselected + slack) continue;
    const double square = (query.cast<double>() - block.row(j).cast<double>()).squaredNorm();
    if (square < match.square) {
      match.square = square;
      match.row = base + j;
    }
  }
}

}  // namespace

void NearestNeighbour::fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) {
  check_clip_pairs(tracks, poses);
  tracks_ = at_mean_where_unknown(stacked(tracks));
  poses_ = stacked(poses);
  half_squares_ = 0.5F * tracks_.rowwise().squaredNorm();
}

std::vector<Eigen::Index> NearestNeighbour::nearest_rows(const MatrixF& track) const {
  check_track(track, tracks_.cols());
  const MatrixF queries = at_mean_where_unknown(track);
  // Bounds the error of ½‖y‖² − x·y in single precision, once for each of the two compared.
  const float longest = std::sqrt(2.0F * half_squares_.maxCoeff());
  const float unit = static_cast<float>(queries.cols() + 2) * std::numeric_limits<float>::epsilon();
  const Eigen::VectorXf slack =
      2.0F * unit * longest * (longest + queries.rowwise().norm().array());

  std::vector<Match> matches(static_cast<std::size_t>(queries.rows()));
  for (Eigen::Index first = 0; first < queries.rows(); first += kTrackBlock) {
    const Eigen::Index count = std::min(kTrackBlock, queries.rows() - first);
    for (Eigen::Index base = 0; base < tracks_.rows(); base += kTrainingBlock) {
      const auto block = tracks_.middleRows(base, std::min(kTrainingBlock, tracks_.rows() - base));
      MatrixF half_distance = queries.middleRows(first, count) * -block.transpose();
      half_distance.rowwise() += half_squares_.segment(base, block.rows()).transpose();
      for (Eigen::Index i = first; i < first + count; ++i)
        update(matches[static_cast<std::size_t>(i)], queries.row(i), half_distance.row(i - first),
               slack(i), block, base);
    }
  }
  std::vector<Eigen::Index> rows(matches.size());
  std::transform(matches.begin(), matches.end(), rows.begin(),
                 [](const Match& match) { return match.row; });
  return rows;
}

MatrixF NearestNeighbour::predict(const MatrixF& track) const {
  return poses_(nearest_rows(track), Eigen::all);
}

}  // namespace mcdbn
