#include "learning/divergence_guard.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "learning/contrastive_divergence.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

std::string what_to_lower(const CrbmShape& shape, const CdSettings& settings) {
  std::vector<std::pair<const char*, double>> used{{"rate", settings.rate}};
  if (shape.order_A() > 0) used.emplace_back("rate-A", settings.rate_A);
  if (shape.order_B() > 0) used.emplace_back("rate-B", settings.rate_B);
  if (settings.persistent && settings.fast_rate > 0)
    used.emplace_back("fast-rate", settings.fast_rate);
  if (learns_deviation(shape, settings))
    used.emplace_back("deviation-rate", settings.deviation_rate);
  used.emplace_back("initial-deviation", settings.initial_deviation);
  const char* kind = shape.kind == VisibleKind::gaussian ? "gaussian" : "binary";
  std::string advice = fmt::format("lower `{}.{}` (now {:g})", kind, used[0].first, used[0].second);
  for (std::size_t i = 1; i < used.size(); ++i)
    advice += fmt::format("{}`{}.{}` ({:g})", i + 1 == used.size() ? " or " : ", ", kind,
                          used[i].first, used[i].second);
  return advice;
}

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
