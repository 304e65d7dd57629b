#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// Numbers of units of a network with a layer for each of two modalities and one above both. In
/// arrays of two the 2D modality comes first.
struct BimodalShape {
  std::array<std::size_t, 2> visible, hidden;
  std::size_t top = 0;
};

/// All training frames: windows of 2D (track_window.hpp) and poses, [frames x dimension] each.
/// @throws ShapeError as check_clip_pairs does
std::array<MatrixF, 2> bimodal_data(const std::vector<MatrixF>& tracks,
                                    const std::vector<MatrixF>& poses);

/// The shape of a network with these hidden layers whose visible units hold a row of the data.
BimodalShape bimodal_shape(const std::array<MatrixF, 2>& data,
                           const std::array<std::size_t, 2>& hidden, std::size_t top);

}  // namespace mcdbn
