#include "learning/learnt_deviation.hpp"

#include <doctest/doctest.h>

#include "learning/small_network.hpp"
#include "machines/answer_batches.hpp"
#include "mcdbn/machines/regeneration.hpp"

namespace learnt_deviation_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Of clips of 20 to 49 frames, answered one after another.
AnswerDeviation one_by_one(const Mcdbn& network, const std::vector<MatrixF>& given,
                           const std::vector<MatrixF>& truth, Eigen::Index frames) {
  MatrixF codes(frames, static_cast<Eigen::Index>(network.cdbns[1].code_dimension()));
  MatrixF residuals(frames, truth.front().cols());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const CodedAnswer answer = coded_answers(network, {given[i]}).front();
    codes.middleRows(row, truth[i].rows()) = answer.code;
    residuals.middleRows(row, truth[i].rows()) = truth[i] - answer.mean;
    row += truth[i].rows();
  }
  return AnswerDeviation::fit(codes, residuals);
}

}  // namespace

TEST_CASE("learnt deviation: many clips in step are as each clip for itself") {
  const NetworkParameters parameters = random_network({4, 3}, {{{{6, 2}}, {{5, 2}}}}, 4, 31);
  std::vector<MatrixF> given, truth;
  Eigen::Index frames = 0;
  for (unsigned i = 0; frames <= kFramesInStep; ++i) {
    const std::size_t length = 20 + i * 7 % 30;
    given.push_back(random_matrix(length, 4, 1000 + i));
    truth.push_back(random_matrix(length, 3, 5000 + i));
    frames += static_cast<Eigen::Index>(length);
  }
  const std::vector<ModalityClips> modalities{{"2d", given}, {"3d", truth}};
  REQUIRE(answer_batches(truth, 1, kFramesInStep).size() > 1);
  on_every_device([&](Device& device) {
    const Mcdbn network = on_device(device, parameters, 1, 4);
    const AnswerDeviation found = learnt_deviation(network, {modalities, {}}, nullptr),
                          expected = one_by_one(network, given, truth, frames);
    // Of answers of one precision; as a deviation is an exponential, off by as many parts.
    constexpr double kBound = 1e-4;
    CHECK((found.C - expected.C).array().abs().maxCoeff() < kBound);
    CHECK((found.c - expected.c).array().abs().maxCoeff() < kBound);
    CHECK(expected.C.array().abs().maxCoeff() > 100 * kBound);
  });
}

}  // namespace learnt_deviation_test
