#pragma once

#include <vector>

#include "learning/fused_down_pass.hpp"
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
  /// @param fused one launch a layer of the down-pass where it can be; else one or two a frame
  UnrolledPass(UnrolledNetwork& network, std::size_t absent, const SequenceWindows& windows,
               bool fused = true);

  /// @param modalities standardized rows of the windows, [windows.rows() x visible], indexed, of
  ///        each modality; those of the absent one are not read
  /// @param kept_share of all hidden units but the absent code; drop-out takes the others, drawn by
  ///        `key`, for a whole window at once: units that flicker would teach the decoder to shake
  void forward(std::span<const Rows> modalities, float kept_share, const RandomKey& key);
  /// The absent modality, [at least windows.rows() x visible]; frames before `first` do not count.
  const Matrix& prediction() const { return prediction_.empty() ? states_.front() : prediction_; }
  /// Where the loss writes its derivative by the prediction; zero before `judged_from`.
  Matrix& prediction_error() { return state_errors_.front(); }
  /// Adds to the gradients of all parameters that took part. Uses up prediction_error().
  void backward();

 private:
  using Layers = std::deque<UnrolledNetwork::Layer>;
  Rows at(const Matrix& matrix, std::size_t frame) const {
    return Rows::strided(matrix, frame, windows_.count, windows_.frames);
  }
  /// Rows of the windows' frames that have a code. @param matrix of all their frames
  Rows coded(const Matrix& matrix) const {
    return Rows::indexed(matrix, coded_index_, 0, code_rows_);
  }
  /// The mean field's units after step 1, 2 …
  Rows step_of(const Matrix& steps, std::size_t step) const {
    return {steps, (step - 1) * code_rows_, code_rows_};
  }
  /// Rows of all frames that have a history of `skipped` frames, in the first window at least.
  Rows from(const Matrix& matrix, std::size_t skipped) const {
    return {matrix, skipped, rows_ - skipped};
  }

  void drop_out(const Rows& units, std::size_t alike);
  /// The up-pass of one present modality.
  struct UpPass {
    std::size_t modality;
    Layers& layers;
    Matrix input;
    /// Hidden units of the layers, of all frames; of the last layer, the code, of those from
    /// `first` on.
    std::vector<Matrix> units;
    std::vector<Matrix> errors;  ///< of all frames; of the last layer only if it is not the first
    Matrix code_error;
  };
  UpPass make_up_pass(std::size_t modality);
  void up_pass(UpPass& up);
  void mean_field();
  void shared_from_start(const Rows& hidden);
  void down_pass();
  void down_pass_by_frames(std::size_t layer);
  void down_pass_backward();
  void down_backward_by_frames(std::size_t layer);
  void add_down_gradients(std::size_t layer);
  void mean_field_backward();
  void add_mean_field_gradients();
  void up_pass_backward(UpPass& up);

  UnrolledNetwork& network_;
  std::size_t absent_;
  SequenceWindows windows_;
  std::size_t rows_, steps_;
  std::size_t coded_frames_, code_rows_;  ///< from `first` on: of a window, of all
  IndexBuffer coded_index_;               ///< their rows among those of all frames
  std::vector<UpPass> up_;
  Layers& down_layers_;
  float kept_share_ = 1.0F;
  RandomKey drop_out_key_;
  Matrix start_, start_input_;  ///< the absent units' start, what it gives the shared ones
  Matrix start_error_;          ///< [1 x MRBM hidden] summed up over the rows
  Matrix present_input_, present_input_error_;  ///< [code rows x MRBM hidden]
  Matrix values_, value_errors_;                ///< of each step, [code rows x code]
  Matrix hidden_, hidden_errors_;               ///< the same, [code rows x MRBM hidden]
  std::vector<Matrix> states_,
      state_errors_;                 ///< visible units of the absent layers, of all frames
  Matrix prediction_;                ///< in the data's units, where the lowest units have others
  std::vector<Matrix> down_errors_;  ///< the same errors, [code rows x visible]
  std::vector<std::optional<FusedDownPass>> fused_;  ///< of the absent layers
  std::vector<Matrix> down_inputs_;                  ///< from above, of those that are fused
};

}  // namespace mcdbn
