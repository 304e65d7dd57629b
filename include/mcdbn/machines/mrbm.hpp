#pragma once

#include <string>
#include <vector>

#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// One kind of data that an MRBM joins with others.
struct Modality {
  std::string name;         ///< in names of tensors
  std::size_t visible = 0;  ///< units
  VisibleKind kind = VisibleKind::binary;
  bool operator==(const Modality&) const = default;
};

struct MrbmShape {
  std::vector<Modality> modalities;  ///< two or more
  std::size_t hidden = 0;            ///< units that all of them share
  bool operator==(const MrbmShape&) const = default;

  /// @throws ShapeError for fewer than two modalities, or a name that comes twice
  void check() const;
};

/// An MRBM's parameters on the host, with the paper's letters; entry m is modality m's.
struct MrbmParameters {
  MrbmShape shape;
  std::vector<MatrixF> W;  ///< [visible of the modality x hidden]
  std::vector<MatrixF> a;  ///< [1 x visible of the modality]
  MatrixF b;               ///< [1 x hidden]

  static MrbmParameters zeros(const MrbmShape& shape);
  /// Every W drawn from N(0, deviation²), biases zero.
  /// @param key of the first modality's W, as CrbmParameters::random takes it; each further one's
  ///        is a step further on
  static MrbmParameters random(const MrbmShape& shape, double deviation, const RandomKey& key);
  /// The contents of a machine's buffer (Mrbm::parameter_shapes), or of one of gradients.
  static MrbmParameters read(const Parameters& from, const MrbmShape& shape);
  /// @throws ShapeError
  void write(Parameters to) const;
};

/// The paper's letters in place among parameters of Mrbm::parameter_shapes, or among gradients.
struct MrbmMatrices {
  MrbmMatrices(const Parameters& parameters, const MrbmShape& shape);
  std::vector<Matrix> W, a;
  Matrix b;
};

/// RBMs, one for each modality, that share their hidden layer (eq 18 to 23). Modalities are binary
/// or Gaussian (variance 1, as data is standardized).
class Mrbm : public MrbmMatrices {
 public:
  /// W_NAME and a_NAME of every modality, then b.
  static std::vector<ParameterShape> parameter_shapes(const MrbmShape& shape);

  /// @throws ShapeError for a shape that check() refuses, or a matrix of another shape than
  ///         MrbmParameters gives for it
  Mrbm(Device& device, const MrbmParameters& start);
  /// An MRBM on existing parameters, which it shares. @param parameters of parameter_shapes(); they
  /// may be part of a larger machine's  @throws ShapeError
  Mrbm(const Parameters& parameters, const MrbmShape& shape);
  MrbmParameters to_host() const;
  const MrbmShape& shape() const { return shape_; }
  std::size_t modality_count() const { return shape_.modalities.size(); }
  std::size_t visible(std::size_t modality) const { return W[modality].rows(); }
  VisibleKind kind(std::size_t modality) const { return shape_.modalities[modality].kind; }
  std::size_t hidden() const { return b.columns(); }
  const Parameters& parameters() const { return parameters_; }
  /// Where kernels find everything of each modality (mrbm_shape.clh).
  const IndexBuffer& layout() const { return layout_; }
  /// The transposed copies, one after another [1 x floats].
  const Parameters& transposed() const { return transposed_; }
  Device& device() const { return b.device(); }

  /// Mean-field inference of the absent modalities (eq 32, 33), started from zeros, `steps` times
  /// (0: once). Sampled inference is MrbmChain's.
  /// @param modalities for each [rows x visible(m)], of as many rows; those `present` are read, the
  ///        others are the result and may not be indexed
  /// @param present of each modality; one at least is not
  /// @throws ShapeError for other counts, columns or rows, and where none is absent
  void infer(const std::vector<Rows>& modalities, const std::vector<bool>& present,
             std::size_t steps) const;
  /// Brings the transposed copies of every W up to date after W changed.
  void refresh_transposed();

  std::vector<Matrix> W_transposed;  ///< [hidden x visible], in transposed()

 private:
  MrbmShape shape_;
  Parameters parameters_, transposed_;
  IndexBuffer layout_;
};

}  // namespace mcdbn
