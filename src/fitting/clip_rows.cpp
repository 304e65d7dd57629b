#include "fitting/clip_rows.hpp"

namespace mcdbn {
namespace {

/// Calls `change` with each matrix of rows, and the same one of the others.
template <typename Change, typename... Rows>
void each_matrix(const Change& change, Rows&... rows) {
  change(rows.prior.mean...);
  change(rows.prior.deviation...);
  change(rows.mean...);
  change(rows.mean_lean...);
  change(rows.root_m...);
  change(rows.track.x_px...);
  change(rows.track.y_px...);
  change(rows.track.confidence...);
}

}  // namespace

ClipRows ClipRows::first(Eigen::Index count) const {
  ClipRows part = *this;
  each_matrix(
      [&](auto& rows) {
        if (rows.rows() > count) rows.conservativeResize(count, Eigen::NoChange);
      },
      part);
  return part;
}

void ClipRows::drop_first(Eigen::Index count) {
  each_matrix(
      [&](auto& rows) {
        if (rows.rows() > 0) rows = rows.bottomRows(rows.rows() - count).eval();
      },
      *this);
}

void ClipRows::append(const ClipRows& more) {
  if (frames() == 0) {
    *this = more;
    return;
  }
  each_matrix(
      [](auto& rows, const auto& others) {
        rows.conservativeResize(rows.rows() + others.rows(), Eigen::NoChange);
        rows.bottomRows(others.rows()) = others;
      },
      *this, more);
}

}  // namespace mcdbn
