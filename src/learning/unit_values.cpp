#include "learning/unit_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

namespace {

void check_row(const MatrixF& values, Eigen::Index row, VisibleKind kind, const std::string& what,
               bool may_be_unknown) {
  for (Eigen::Index c = 0; c < values.cols(); ++c) {
    const float x = values(row, c);
    if (may_be_unknown && std::isnan(x)) continue;
    if (!std::isfinite(x))
      throw InputError(fmt::format(
          "{}: row {}, column {} is {}; {}", what, row + 1, c + 1, x,
          may_be_unknown ? "a number is needed, or nan" : "numbers are needed throughout"));
    if (kind == VisibleKind::binary && (x < 0.0F || x > 1.0F))
      throw InputError(
          fmt::format("{}: row {}, column {} is {}; binary units need values from 0 to 1 "
                      "(Gaussian units take any)",
                      what, row + 1, c + 1, x));
  }
}

bool same_clips(const Sequences& x, const Sequences& y) {
  return x.values.rows() == y.values.rows() &&
         std::ranges::equal(x.clips, y.clips, [](const auto& a, const auto& b) {
           return a.first == b.first && a.frames == b.frames;
         });
}

}  // namespace

void check_unit_values(const MatrixF& values, VisibleKind kind, const std::string& what,
                       bool may_be_unknown) {
  for (Eigen::Index row = 0; row < values.rows(); ++row)
    check_row(values, row, kind, what, may_be_unknown);
}

void check_unit_values(const Sequences& data, VisibleKind kind, const std::string& what) {
  const MatrixF values = data.values.to_host();
  for (const std::int32_t row : data.window_rows(0)) check_row(values, row, kind, what, false);
}

void check_codes(std::span<const Sequences> codes, std::span<const Modality> modalities) {
  if (codes.size() != modalities.size())
    throw ShapeError(
        fmt::format("MRBM: sequences of {} modalities, not {}", codes.size(), modalities.size()));
  for (std::size_t m = 0; m < codes.size(); ++m) {
    const Modality& modality = modalities[m];
    if (codes[m].values.columns() != modality.visible)
      throw ShapeError(fmt::format("MRBM: {} has {} visible units, its sequences {} columns",
                                   modality.name, modality.visible, codes[m].values.columns()));
    if (!same_clips(codes[m], codes.front()))
      throw ShapeError(fmt::format("MRBM: the sequences of {} and {} differ in their clips' rows",
                                   modality.name, modalities.front().name));
  }
  for (std::size_t m = 0; m < codes.size(); ++m)
    check_unit_values(codes[m], modalities[m].kind, modalities[m].name);
}

}  // namespace mcdbn
