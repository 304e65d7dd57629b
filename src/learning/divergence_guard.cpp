#include "learning/divergence_guard.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

DivergenceGuard::DivergenceGuard(std::string stage, std::string advice)
    : stage_(std::move(stage)), advice_(std::move(advice)) {}

void DivergenceGuard::check(std::size_t epoch, double loss) {
  const bool grown = best_ >= 0 && loss > kGrowth * best_;
  if (!std::isfinite(loss) || grown)
    throw DivergenceError(fmt::format(
        "training diverged in stage {} at epoch {}: the loss is {:.4g}{}; {}", stage_, epoch, loss,
        best_ >= 0 ? fmt::format(", the best was {:.4g}", best_) : "", advice_));
  if (best_ < 0 || loss < best_) best_ = loss;
}

}  // namespace mcdbn
