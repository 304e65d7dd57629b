#pragma once

#include "mcdbn/learning/sequence_source.hpp"
#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

/// How sure a trained network of two modalities is of the second (AnswerDeviation): from its
/// answers to whole sequences of the first, as regeneration gives them, to clips that it has learnt
/// from and, where there are some, calibrated on clips that it has not. Where there are many frames
/// every n-th sequence is taken.
/// @param held_out clips that nothing was learnt from, or none
/// @throws ShapeError if there are no two frames
AnswerDeviation learnt_deviation(const Mcdbn& network, const SynchronizedClips& clips,
                                 const SynchronizedClips* held_out);

}  // namespace mcdbn
