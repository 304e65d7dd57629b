// The settings of the fit: defaults and ranges.

#include <doctest/doctest.h>

#include "base/settings_table.hpp"
#include "mcdbn/fitting/track_fit.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("track fit settings: every one has its default, its own name and its own member") {
  using S = TrackFitSettings;
  const std::vector<Expected<S>> table = {
      {"turn", [](S& s) { return at(s.turn_deg); }, "9"},
      {"doubt", [](S& s) { return at(s.doubt); }, "0.4"},
      {"likeness", [](S& s) { return at(s.likeness); }, "0.75"},
      {"lasting", [](S& s) { return at(s.lasting_s); }, "0.17"},
      {"root", [](S& s) { return at(s.root_m_s2); }, "3"},
      {"detector", [](S& s) { return at(s.detector); }, "0.009"},
      {"noise-lasts", [](S& s) { return at(s.noise_lasts_s); }, "0.35"},
      {"caution", [](S& s) { return at(s.caution); }, "2"},
      {"proportions", [](S& s) { return at(s.proportions); }, "0.1"},
      {"footing", [](S& s) { return at(s.footing_m_s); }, "0.5"},
      {"solutions", [](S& s) { return at(s.solutions); }, "5"},
      {"spread", [](S& s) { return at(s.spread); }, "1.3"}};
  check_table(table);
  CHECK(member_count<S>() == table.size());
}

TEST_CASE("track fit settings: deviations are above nothing, a likeness leaves something") {
  for (const char* name :
       {"turn", "lasting", "root", "detector", "caution", "proportions", "footing", "spread"})
    for (const double value : {0.0, -1.0, kNan})
      check_refused<TrackFitSettings>(name, value, "above 0");
  check_refused<TrackFitSettings>("likeness", 1, "at least 0 and below 1");
  check_refused<TrackFitSettings>("noise-lasts", -0.01, "at least 0");
  for (const double value : {-0.01, 1.01})
    check_refused<TrackFitSettings>("doubt", value, "at least 0 and at most 1");
  for (const double value : {0.0, 1.0}) check_accepted<TrackFitSettings>("doubt", value);
  check_accepted<TrackFitSettings>("likeness", 0);
  check_accepted<TrackFitSettings>("noise-lasts", 0);
}
