#include "learning/code_stack.hpp"

#include "device/pointwise.hpp"

namespace mcdbn {

std::size_t all_units(const Mrbm& mrbm) {
  std::size_t units = 0;
  for (const Matrix& W : mrbm.W) units += padded(W.rows());
  return units;
}

std::size_t all_panels(const Mrbm& mrbm, const RowTile& tile) {
  std::size_t panels = 0;
  for (const Matrix& W : mrbm.W) panels += update_panels(tile, padded(W.rows()));
  return panels;
}

/// Two at a time; of an odd number one comes twice.
void gather_codes(std::span<const Rows> codes, std::size_t block, const Matrix& stack) {
  std::vector<std::size_t> first{0};
  for (const Rows& rows : codes) first.push_back(first.back() + block * padded(rows.columns));
  for (std::size_t m = 1; m < codes.size(); m += 2)
    gather_two(codes[m - 1], codes[m], stack, first[m - 1], first[m]);
  const std::size_t last = codes.size() - 1;
  if (last % 2 == 0) gather_two(codes[last - 1], codes[last], stack, first[last - 1], first[last]);
}

}  // namespace mcdbn
