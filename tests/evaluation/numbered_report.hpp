#pragma once

#include <map>
#include <string>
#include <vector>

#include "evaluation/evaluation_report.hpp"

namespace mcdbn::test {

/// A score of which every figure follows from `number` in a way of its own.
ClipScore numbered_score(double number);
/// The figures of such scores' mean, by the names that reports use.
std::map<std::string, double> numbered_figures(const std::vector<double>& numbers);

/// Two actions, "walk" of three clips and "jump" of two, of different lengths, two samples each,
/// the second one the better, a mean-field answer and two baselines. The scores are numbered:
/// sample s of clip c has number 10·c + 3 − s.
EvaluationReport numbered_report();
/// The numbers of the samples of the clips of an action (of all: "").
std::vector<double> sample_numbers(const EvaluationReport& report, const std::string& action);

inline constexpr double kRidgeNumber = 57, kMeanPoseNumber = 33, kMeanFieldNumber = 2;

}  // namespace mcdbn::test
