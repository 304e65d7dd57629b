// Rows of a growing clip that come and go.

#include "fitting/clip_rows.hpp"

#include <doctest/doctest.h>

namespace clip_rows_test {

using namespace mcdbn;

namespace {

/// Each matrix counts its frames by numbers of its own.
ClipRows counted(Eigen::Index first, Eigen::Index frames, bool with_deviation) {
  const auto from = [&](double start, Eigen::Index columns) -> MatrixD {
    return Eigen::VectorXd::LinSpaced(frames, start + static_cast<double>(first),
                                      start + static_cast<double>(first + frames - 1))
        .replicate(1, columns);
  };
  ClipRows rows;
  rows.prior.mean = from(100, 4).cast<float>();
  if (with_deviation) rows.prior.deviation = from(200, 4).cast<float>();
  rows.mean = from(300, 6);
  rows.mean_lean = from(400, 3);
  rows.root_m = from(500, 3);
  rows.track.joint_names = {"Hips", "Neck"};
  rows.track.x_px = from(600, 2);
  rows.track.y_px = from(700, 2);
  rows.track.confidence = from(800, 2);
  return rows;
}

void check_same(const ClipRows& got, const ClipRows& want) {
  CHECK(got.frames() == want.frames());
  CHECK(got.prior.mean == want.prior.mean);
  CHECK(got.prior.deviation == want.prior.deviation);
  CHECK(got.mean == want.mean);
  CHECK(got.mean_lean == want.mean_lean);
  CHECK(got.root_m == want.root_m);
  CHECK(got.track.joint_names == want.track.joint_names);
  CHECK(got.track.x_px == want.track.x_px);
  CHECK(got.track.y_px == want.track.y_px);
  CHECK(got.track.confidence == want.track.confidence);
}

}  // namespace

TEST_CASE("clip rows: the first, the rest, and both one after the other") {
  for (const bool with_deviation : {true, false}) {
    CAPTURE(with_deviation);
    const ClipRows all = counted(0, 7, with_deviation);
    check_same(all.first(3), counted(0, 3, with_deviation));
    ClipRows rest = all;
    rest.drop_first(3);
    check_same(rest, counted(3, 4, with_deviation));
    ClipRows both = all.first(3);
    both.append(rest);
    check_same(both, all);
  }
}

TEST_CASE("clip rows: none, and all") {
  ClipRows rows;
  CHECK(rows.frames() == 0);
  rows.append(counted(0, 2, true));
  check_same(rows, counted(0, 2, true));
  rows.drop_first(0);
  check_same(rows, counted(0, 2, true));
  rows.drop_first(2);
  CHECK(rows.frames() == 0);
  rows.append(counted(2, 1, true));
  check_same(rows, counted(2, 1, true));
}

}  // namespace clip_rows_test
