#include "comparison/bimodal_data.hpp"

#include <utility>

#include "comparison/track_window.hpp"

namespace mcdbn {

std::array<MatrixF, 2> bimodal_data(const std::vector<MatrixF>& tracks,
                                    const std::vector<MatrixF>& poses) {
  WindowPairs pairs = window_pairs(tracks, poses);
  return {std::move(pairs.windows), std::move(pairs.poses)};
}

BimodalShape bimodal_shape(const std::array<MatrixF, 2>& data,
                           const std::array<std::size_t, 2>& hidden, std::size_t top) {
  return {{static_cast<std::size_t>(data[0].cols()), static_cast<std::size_t>(data[1].cols())},
          hidden,
          top};
}

}  // namespace mcdbn
