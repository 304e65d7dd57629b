#include "device/launch_trace.hpp"

namespace mcdbn {
namespace {

double microseconds(std::uint64_t from_ns, std::uint64_t to_ns) {
  return to_ns > from_ns ? 1e-3 * static_cast<double>(to_ns - from_ns) : 0.0;
}

}  // namespace

void LaunchTrace::add(const std::string& step, const std::vector<LaunchTime>& times) {
  auto& events = trace_["traceEvents"];
  const int row = ++steps_;
  events.push_back(
      {{"name", "thread_name"}, {"ph", "M"}, {"pid", 1}, {"tid", row}, {"args", {{"name", step}}}});
  for (const LaunchTime& launch : times)
    events.push_back(
        {{"name", launch.kernel},
         {"ph", "X"},
         {"pid", 1},
         {"tid", row},
         {"ts", microseconds(times.front().started_ns, launch.started_ns)},
         {"dur", microseconds(launch.started_ns, launch.ended_ns)},
         {"args", {{"waited_us", microseconds(launch.queued_ns, launch.started_ns)}}}});
}

}  // namespace mcdbn
