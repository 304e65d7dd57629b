#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mcdbn/base/matrices.hpp"

namespace mcdbn {

/// How many of the 90 % intervals that a method gives hold the truth (interval_share.hpp), name by
/// name.
class Coverage {
 public:
  struct Share {
    double held = 0, all = 0;
    double deviations = 0;  ///< summed up
    double share() const { return held / all; }
    double mean_deviation() const { return deviations / all; }
  };

  /// @param names of groups of columns, as many in each: a joint's three, a feature's one
  /// @param truth, mean, deviation [frames x columns]; numbers that are not finite do not count
  /// @throws ShapeError
  void add(const std::vector<std::string>& names, const MatrixD& truth, const MatrixD& mean,
           const MatrixD& deviation);

  /// Adds another's counts.
  void add(const Coverage& other);

  const std::map<std::string, Share>& by_name() const { return shares_; }
  Share overall() const;
  bool empty() const { return shares_.empty(); }

 private:
  std::map<std::string, Share> shares_;
};

/// {"all": {"share", "mean_deviation"}, "by_name": {name: …}}
nlohmann::ordered_json coverage_json(const Coverage& coverage);

}  // namespace mcdbn
