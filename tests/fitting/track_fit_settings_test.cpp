// The settings of the fit: defaults and ranges.

#include <doctest/doctest.h>

#include "base/settings_table.hpp"
#include "mcdbn/fitting/track_fit.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("track fit settings: every one has its default, its own name and its own member") {
  using S = TrackFitSettings;
  const std::vector<Expected<S>> table = {
      {"turn", [](S& s) { return at(s.turn_deg); }, "25"},
      {"change", [](S& s) { return at(s.change); }, "0.4"},
      {"likeness", [](S& s) { return at(s.likeness); }, "0.5"},
      {"position", [](S& s) { return at(s.position_m); }, "0.1"},
      {"footing", [](S& s) { return at(s.footing_m); }, "0.0125"},
      {"caution", [](S& s) { return at(s.caution); }, "2"},
      {"proportions", [](S& s) { return at(s.proportions_m); }, "0"},
      {"bend", [](S& s) { return at(s.bend_m_s2); }, "0.7"},
      {"fade", [](S& s) { return at(s.fade_s); }, "0.1"}};
  check_table(table);
  CHECK(member_count<S>() == table.size());
}

TEST_CASE("track fit settings: deviations are above nothing, a likeness leaves something") {
  for (const char* name : {"turn", "change", "position", "footing", "caution", "bend", "fade"})
    for (const double value : {0.0, -1.0, kNan})
      check_refused<TrackFitSettings>(name, value, "above 0");
  check_refused<TrackFitSettings>("likeness", 1, "at least 0 and below 1");
  check_refused<TrackFitSettings>("proportions", -0.01, "at least 0");
  check_accepted<TrackFitSettings>("likeness", 0);
  check_accepted<TrackFitSettings>("proportions", 0);
}
