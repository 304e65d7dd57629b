#include "learning/learnt_deviation.hpp"

#include <algorithm>
#include <span>

#include "mcdbn/machines/regeneration.hpp"

namespace mcdbn {
namespace {

/// Frames from which the deviation is learnt: some hundred for each unit of a code.
constexpr Eigen::Index kMostFrames = 60000;
/// Sequences that run in step.
constexpr std::size_t kAtOnce = 32;

struct Answers {
  MatrixF codes, residuals;  ///< [frames x code], [frames x visible]
};

/// Every n-th of `clips`, so that they are not many more than kMostFrames.
std::vector<std::size_t> some_of(std::span<const MatrixF> clips) {
  Eigen::Index frames = 0;
  for (const MatrixF& clip : clips) frames += clip.rows();
  const auto every = static_cast<std::size_t>(std::max<Eigen::Index>(1, frames / kMostFrames));
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < clips.size(); i += every) some.push_back(i);
  return some;
}

Answers answers_to(const Mcdbn& network, const SynchronizedClips& clips) {
  const std::span<const MatrixF> given = clips.modalities[0].clips,
                                 truth = clips.modalities[1].clips;
  const std::vector<std::size_t> some = some_of(truth);
  Eigen::Index frames = 0;
  for (const std::size_t i : some) frames += truth[i].rows();
  Answers answers{MatrixF(frames, static_cast<Eigen::Index>(network.cdbns[1].code_dimension())),
                  MatrixF(frames, static_cast<Eigen::Index>(clips.modalities[1].dimension()))};
  Eigen::Index done = 0;
  for (std::size_t first = 0; first < some.size(); first += kAtOnce) {
    const std::span now(some.begin() + static_cast<std::ptrdiff_t>(first),
                        std::min(kAtOnce, some.size() - first));
    std::vector<MatrixF> sequences;
    for (const std::size_t i : now) sequences.push_back(given[i]);
    const std::vector<CodedAnswer> answered = coded_answers(network, sequences);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const MatrixF& pose = truth[now[i]];
      answers.codes.middleRows(done, pose.rows()) = answered[i].code;
      answers.residuals.middleRows(done, pose.rows()) = pose - answered[i].mean;
      done += pose.rows();
    }
  }
  return answers;
}

}  // namespace

AnswerDeviation learnt_deviation(const Mcdbn& network, const SynchronizedClips& clips,
                                 const SynchronizedClips* strangers) {
  const Answers learnt = answers_to(network, clips);
  AnswerDeviation deviation = AnswerDeviation::fit(learnt.codes, learnt.residuals);
  if (strangers != nullptr) {
    const Answers unseen = answers_to(network, *strangers);
    deviation.calibrate(unseen.residuals, deviation.of(unseen.codes));
  }
  return deviation;
}

}  // namespace mcdbn
