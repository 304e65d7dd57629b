#include "evaluation/coverage.hpp"

#include <cmath>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/evaluation/interval_share.hpp"

namespace mcdbn {
namespace {

void add_to(Coverage::Share& sum, const Coverage::Share& more) {
  sum.held += more.held;
  sum.all += more.all;
  sum.deviations += more.deviations;
}

nlohmann::ordered_json share_json(const Coverage::Share& share) {
  return {{"share", share.share()}, {"mean_deviation", share.mean_deviation()}};
}

}  // namespace

void Coverage::add(const std::vector<std::string>& names, const MatrixD& truth, const MatrixD& mean,
                   const MatrixD& deviation) {
  const auto same = [&](const MatrixD& other) {
    return other.rows() == truth.rows() && other.cols() == truth.cols();
  };
  if (!same(mean) || !same(deviation) || names.empty() || truth.cols() % std::ssize(names) != 0)
    throw ShapeError("coverage: truth, mean and deviation differ in shape");
  const Eigen::Index columns = truth.cols() / std::ssize(names);
  for (Eigen::Index column = 0; column < truth.cols(); ++column) {
    Share& share = shares_[names[static_cast<std::size_t>(column / columns)]];
    for (Eigen::Index t = 0; t < truth.rows(); ++t) {
      const double off = std::abs(truth(t, column) - mean(t, column)), sure = deviation(t, column);
      if (!std::isfinite(off) || !std::isfinite(sure)) continue;
      ++share.all;
      share.held += off <= kReachOf90 * sure;
      share.deviations += sure;
    }
  }
}

void Coverage::add(const Coverage& other) {
  for (const auto& [name, share] : other.shares_) add_to(shares_[name], share);
}

Coverage::Share Coverage::overall() const {
  Share sum;
  for (const auto& [name, share] : shares_) add_to(sum, share);
  return sum;
}

nlohmann::ordered_json coverage_json(const Coverage& coverage) {
  nlohmann::ordered_json by_name;
  for (const auto& [name, share] : coverage.by_name()) by_name[name] = share_json(share);
  return {{"all", share_json(coverage.overall())}, {"by_name", by_name}};
}

}  // namespace mcdbn
