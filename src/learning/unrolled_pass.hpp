#pragma once

#include <vector>

#include "learning/unrolled_network.hpp"
#include "mcdbn/learning/sequence_loss.hpp"

namespace mcdbn {

/// One direction of fine-tuning (Goodfellow et al. 2013 through a whole MCDBN): up-pass
/// of the present modalities' CDBNs, mean field of the MRBM (eq 32, 33), down-pass of the absent
/// one's on its own output from the training mean (Algorithm 3), and the back-propagation of an
/// error at that output through all of it, through time.
class UnrolledPass {
 public:
  /// @throws ShapeError if `first` leaves less history than the layers need
  /// @param absent the one modality that is predicted from all others
  UnrolledPass(UnrolledNetwork& network, std::size_t absent, const SequenceWindows& windows);

  /// @param modalities standardized rows of the windows, [windows.rows() x visible], indexed, of
  ///        each modality; those of the absent one are not read
  /// @param kept_share of all hidden units but the absent code; drop-out takes the others, drawn by
  /// `key`, for a
  ///        whole window at once: units that flicker would teach the decoder to shake
  void forward(std::span<const Rows> modalities, float kept_share, const RandomKey& key);
  /// The absent modality, [at least windows.rows() x visible]; frames before `first` do not count.
  const Matrix& prediction() const { return states_.front(); }
  /// Where the loss writes its derivative by the prediction; zero before `lead`.
  Matrix& prediction_error() { return state_errors_.front(); }
  /// Adds to the gradients of all parameters that took part. Uses up prediction_error().
  void backward();

 private:
  using Layers = std::deque<UnrolledNetwork::Layer>;
  Rows at(const Matrix& matrix, std::size_t frame) const {
    return Rows::strided(matrix, frame, windows_.count, windows_.frames);
  }
  Rows value(std::size_t step) const { return {values_, step * rows_, rows_}; }
  Rows hidden(std::size_t step) const { return {hidden_, (step - 1) * rows_, rows_}; }
  /// Rows of all frames that have a history of `skipped` frames, in the first window at least.
  Rows from(const Matrix& matrix, std::size_t skipped) const {
    return {matrix, skipped, rows_ - skipped};
  }

  void drop_out(const Rows& units, std::size_t alike);
  /// What one present modality needs for its way up.
  struct UpPass {
    std::size_t modality;
    Layers& layers;
    Matrix input;
    std::vector<Matrix> units, errors;  ///< hidden units of the layers
  };
  UpPass make_up_pass(std::size_t modality);
  void up_pass(UpPass& up);
  void mean_field();
  void down_pass();
  void down_pass_backward();
  void mean_field_backward();
  void up_pass_backward(UpPass& up);

  UnrolledNetwork& network_;
  std::size_t absent_;
  SequenceWindows windows_;
  std::size_t rows_, steps_;
  std::vector<UpPass> up_;
  Layers& down_layers_;
  float kept_share_ = 1.0F;
  RandomKey drop_out_key_;
  Matrix drive_, drive_error_;                 ///< [rows x MRBM hidden]
  Matrix values_, value_errors_;               ///< steps + 1 and steps blocks of rows
  Matrix hidden_, hidden_errors_;              ///< steps blocks of rows
  std::vector<Matrix> states_, state_errors_;  ///< visible units of the absent layers
};

}  // namespace mcdbn
