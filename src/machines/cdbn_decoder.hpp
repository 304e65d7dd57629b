#pragma once

#include "device/row_tile.hpp"
#include "mcdbn/machines/cdbn.hpp"
#include "mcdbn/machines/regeneration.hpp"

namespace mcdbn {

/// The down-pass of a CDBN on its own output (Algorithm 5), over many sequences together, frame by
/// frame. A layer is a product over all frames and one launch that runs from frame to frame
/// (cdbn_decoder.cl); where its state does not fit the device's local memory, some launches a frame
/// instead.
class CdbnDecoder {
 public:
  /// @param code [sequences·frames x code_dimension], one sequence after another
  CdbnDecoder(const Cdbn& cdbn, const Matrix& code, std::size_t sequences);
  /// On visible rows of the caller's, one matrix for each layer, of code's rows: those before the
  /// first decoded frame are its history. @throws ShapeError
  CdbnDecoder(const Cdbn& cdbn, const Matrix& code, std::size_t sequences,
              std::vector<Matrix> states);

  /// Fills in the visible rows of frame `first` … `last` − 1 of every sequence, in order; frames
  /// before `first` are history, at the training mean unless the caller's. Enqueues and returns.
  /// @param fused false: some launches a frame, wherever it would fit
  /// @throws ShapeError if `first` leaves less than the largest order of a layer as history
  void decode(std::size_t first, std::size_t last, const RegenerationOptions& options,
              bool fused = true);

  /// [sequences·frames x visible dimension]
  const Matrix& visible() const { return states_.front(); }

 private:
  Rows at(const Matrix& matrix, std::size_t frame) const {
    return Rows::strided(matrix, frame, sequences_, frames_);
  }
  void decode_frames(std::size_t first, std::size_t last, const RegenerationOptions& options,
                     bool sampled);
  std::optional<std::vector<RowTile>> fused_tiles(bool sampled) const;
  void fused_decode(std::size_t first, std::size_t last, const RegenerationOptions& options,
                    const std::vector<RowTile>& tiles);
  void fused_means(std::size_t layer, std::size_t first, std::size_t last, const RowTile& tile);
  void fused_samples(std::size_t first, std::size_t last, const RegenerationOptions& options,
                     const RowTile& tile);
  /// a + (layer above)·Wᵀ of all frames at once, where the down-pass picks it up.
  void set_input_from_above(std::size_t layer, std::size_t first, std::size_t last);
  void sample_top_layer(std::size_t frame, const RegenerationOptions& options);
  void down_pass(std::size_t frame, bool top_has_input);

  const Cdbn& cdbn_;
  const Matrix& code_;
  std::size_t sequences_, frames_;
  std::vector<Matrix> states_;  ///< the visible rows of each layer
  Matrix top_, top_sample_, top_bias_, below_sample_, below_bias_;  // Gibbs mode, one frame
};

}  // namespace mcdbn
