#pragma once

#include <utility>

#include "mcdbn/learning/epoch_report.hpp"

namespace mcdbn {

/// Turns the progress of each part into that of the whole; has to outlive the observers that it
/// makes.
class OverallProgress {
 public:
  /// @param observer of the whole, or none  @param total cost of all parts
  OverallProgress(EpochObserver observer, double total)
      : observer_(std::move(observer)), total_(total) {}

  /// The observer of the part that follows the ones before, of such a share in the total.
  EpochObserver part(double cost) {
    const double before = done_;
    done_ += cost;
    if (!observer_) return {};
    return [this, before, cost](EpochReport report) {
      report.overall_progress = (before + cost * report.overall_progress) / total_;
      observer_(report);
    };
  }

 private:
  EpochObserver observer_;
  double total_;
  double done_ = 0;
};

}  // namespace mcdbn
