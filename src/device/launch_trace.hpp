#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// Launches as the trace that Chrome and Perfetto show: one row a step, an event a launch, with how
/// long it had waited. Times are microseconds since the step's first launch began.
class LaunchTrace {
 public:
  void add(const std::string& step, const std::vector<LaunchTime>& times);
  /// {"traceEvents": […]}
  const nlohmann::ordered_json& json() const { return trace_; }

 private:
  nlohmann::ordered_json trace_ = {{"traceEvents", nlohmann::ordered_json::array()}};
  int steps_ = 0;
};

}  // namespace mcdbn
