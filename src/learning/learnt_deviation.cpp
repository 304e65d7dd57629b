#include "learning/learnt_deviation.hpp"

#include <algorithm>
#include <span>

#include "machines/answer_batches.hpp"
#include "mcdbn/machines/regeneration.hpp"

namespace mcdbn {
namespace {

/// Frames from which the deviation is learnt: some hundred for each unit of a code.
constexpr Eigen::Index kMostFrames = 60000;

struct Answers {
  MatrixF codes, residuals;  ///< [frames x code], [frames x visible]
};

/// To every n-th of the clips, so that the frames are not many more than kMostFrames.
Answers answers_to(const Mcdbn& network, const SynchronizedClips& clips) {
  const std::span<const MatrixF> given = clips.modalities[0].clips,
                                 truth = clips.modalities[1].clips;
  const auto every =
      static_cast<std::size_t>(std::max<Eigen::Index>(1, total_frames(truth) / kMostFrames));
  const std::vector<AnswerBatch> batches = answer_batches(truth, every, kFramesInStep);
  Eigen::Index frames = 0;
  for (const AnswerBatch& batch : batches)
    for (const SequencePart& part : batch) frames += part.frames;
  Answers answers{MatrixF(frames, static_cast<Eigen::Index>(network.cdbns[1].code_dimension())),
                  MatrixF(frames, static_cast<Eigen::Index>(clips.modalities[1].dimension()))};
  for (const AnswerBatch& batch : batches) {
    const std::vector<CodedAnswer> answered = coded_answers(network, rows_of(batch, given));
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const SequencePart& part = batch[i];
      answers.codes.middleRows(part.row, part.frames) = answered[i].code;
      answers.residuals.middleRows(part.row, part.frames) =
          truth[part.sequence].middleRows(part.first, part.frames) - answered[i].mean;
    }
  }
  return answers;
}

}  // namespace

AnswerDeviation learnt_deviation(const Mcdbn& network, const SynchronizedClips& clips,
                                 const SynchronizedClips* held_out) {
  const Answers learnt = answers_to(network, clips);
  AnswerDeviation deviation = AnswerDeviation::fit(learnt.codes, learnt.residuals);
  if (held_out != nullptr) {
    const Answers unseen = answers_to(network, *held_out);
    deviation.calibrate(unseen.residuals, deviation.of(unseen.codes));
  }
  return deviation;
}

}  // namespace mcdbn
