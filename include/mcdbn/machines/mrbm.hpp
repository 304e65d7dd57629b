#pragma once

#include <array>

#include "mcdbn/base/random.hpp"
#include "mcdbn/device/parameters.hpp"

namespace mcdbn {

/// The two modalities of the MRBM, in the order in which its arrays hold them.
enum class Modality : std::size_t { track = 0, pose = 1 };  // 2D, 3D
constexpr std::size_t index_of(Modality modality) {
  return static_cast<std::size_t>(modality);
}
/// In names of tensors.
constexpr std::array<const char*, 2> kModalityNames{"track", "pose"};
constexpr Modality other(Modality modality) {
  return modality == Modality::track ? Modality::pose : Modality::track;
}

struct MrbmParameters {
  std::array<MatrixF, 2> W;  ///< [visible of the modality x hidden]
  std::array<MatrixF, 2> a;  ///< [1 x visible of the modality]
  MatrixF b;                 ///< [1 x hidden]

  static MrbmParameters random(std::size_t track, std::size_t pose, std::size_t hidden,
                               double deviation, const RandomKey& key);
  /// What stands in a machine's buffer (Mrbm::parameter_shapes), or in one of gradients.
  static MrbmParameters read(const Parameters& from);
  /// @throws ShapeError
  void write(Parameters to) const;
};

/// The paper's letters in place among parameters of Mrbm::parameter_shapes, or among gradients.
struct MrbmMatrices {
  explicit MrbmMatrices(const Parameters& parameters);
  std::array<Matrix, 2> W, a;
  Matrix b;
};

/// Two binary RBMs that share their hidden layer (eq 18 to 23).
class Mrbm : public MrbmMatrices {
 public:
  /// W_track, a_track, W_pose, a_pose, b.
  static std::vector<ParameterShape> parameter_shapes(const std::array<std::size_t, 2>& visible,
                                                      std::size_t hidden);

  Mrbm(Device& device, const MrbmParameters& start);
  /// Of these parameters as they are, of parameter_shapes(); they may stand among those of a larger
  /// machine. @throws ShapeError
  explicit Mrbm(const Parameters& parameters);
  MrbmParameters to_host() const;
  std::size_t visible(Modality modality) const { return W[index_of(modality)].rows(); }
  std::size_t hidden() const { return b.columns(); }
  const Parameters& parameters() const { return parameters_; }
  /// Where kernels find everything of each modality (mrbm_shape.clh).
  const IndexBuffer& layout() const { return layout_; }
  /// The transposed copies, one after another [1 x floats].
  const Parameters& transposed() const { return transposed_; }
  Device& device() const { return b.device(); }

  /// Mean-field inference of the absent modality (eq 32, 33), started from zeros, `steps` times.
  /// With `doubled` the first pass counts the present modality twice in place of the absent one's
  /// zeros (Sohn et al.). Sampled inference is MrbmChain's.
  /// @param present [rows x visible(modality)]  @param absent [rows x visible(other)] result
  void infer(Modality modality, const Rows& present, std::size_t steps, const Rows& absent,
             bool doubled = false) const;
  void refresh_transposed();

  std::array<Matrix, 2> W_transposed;  ///< [hidden x visible], in transposed()

 private:
  Parameters parameters_, transposed_;
  IndexBuffer layout_;
};

}  // namespace mcdbn
