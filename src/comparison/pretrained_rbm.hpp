#pragma once

#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

struct PretrainingSettings {
  std::size_t epochs = 5;
  double rate = 1e-3;
  std::size_t batch = 100;
  std::size_t least_batches = 40;  ///< an epoch
};

struct PretrainedRbm {
  CrbmParameters parameters;
  MatrixF codes;  ///< [rows x hidden] p(h = 1 | v) of the data
};

/// An RBM (order 0) trained by CD-1 for a layer of a deeper network to start from.
/// @param data [rows x visible]  @param key its stream is drawn from alone
PretrainedRbm pretrained_rbm(Device& device, const MatrixF& data, const CrbmShape& shape,
                             const PretrainingSettings& settings, RandomKey key);

}  // namespace mcdbn
