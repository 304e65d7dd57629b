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
      {"likeness", [](S& s) { return at(s.likeness); }, "0.6"},
      {"lasting", [](S& s) { return at(s.lasting_s); }, "0.1"},
      {"measured-lasting", [](S& s) { return at(s.measured_lasting_s); }, "0.2"},
      {"measured-caution", [](S& s) { return at(s.measured_caution); }, "1.7"},
      {"exact", [](S& s) { return at(s.exact); }, "0.3"},
      {"exact-likeness", [](S& s) { return at(s.exact_likeness); }, "0.3"},
      {"exact-noise", [](S& s) { return at(s.exact_noise_px); }, "0.02"},
      {"exact-cost", [](S& s) { return at(s.exact_cost); }, "1.5"},
      {"root", [](S& s) { return at(s.root_m_s2); }, "3"},
      {"detector", [](S& s) { return at(s.detector); }, "0.009"},
      {"noise-lasts", [](S& s) { return at(s.noise_lasts_s); }, "0.35"},
      {"caution", [](S& s) { return at(s.caution); }, "2"},
      {"outlier", [](S& s) { return at(s.outlier); }, "4"},
      {"proportions", [](S& s) { return at(s.proportions); }, "0.5"},
      {"arm-proportions", [](S& s) { return at(s.arm_proportions); }, "0.15"},
      {"leg-proportions", [](S& s) { return at(s.leg_proportions); }, "0.06"},
      {"part-proportions", [](S& s) { return at(s.part_proportions); }, "0.1"},
      {"people", [](S& s) { return at(s.people); }, "0.1"},
      {"footing", [](S& s) { return at(s.footing_m_s); }, "0.5"},
      {"ground", [](S& s) { return at(s.ground_m); }, "0.05"},
      {"step", [](S& s) { return at(s.step_s); }, "0.5"},
      {"pitch", [](S& s) { return at(s.pitch_deg); }, "10"},
      {"roll", [](S& s) { return at(s.roll_deg); }, "8"},
      {"balance", [](S& s) { return at(s.balance_deg); }, "5"},
      {"balance-speed", [](S& s) { return at(s.balance_speed_m_s); }, "1.5"},
      {"balance-bent-legs", [](S& s) { return at(s.balance_bent_legs); }, "0.2"},
      {"focal", [](S& s) { return at(s.focal); }, "0.1"},
      {"roughly", [](S& s) { return at(s.roughly_s); }, "0.1"},
      {"solutions", [](S& s) { return at(s.solutions); }, "5"},
      {"alternatives", [](S& s) { return at(s.alternatives); }, "4"},
      {"spread", [](S& s) { return at(s.spread); }, "1.2"},
      {"draws-noise-lasts", [](S& s) { return at(s.draws_noise_lasts_s); }, "10"}};
  check_table(table);
  CHECK(member_count<S>() == table.size());
}

TEST_CASE("track fit settings: deviations are above nothing, a likeness leaves something") {
  for (const char* name : {"turn",
                           "lasting",
                           "root",
                           "detector",
                           "caution",
                           "proportions",
                           "people",
                           "footing",
                           "spread",
                           "outlier",
                           "ground",
                           "step",
                           "pitch",
                           "roll",
                           "balance",
                           "focal",
                           "exact-noise",
                           "measured-lasting",
                           "measured-caution",
                           "arm-proportions",
                           "leg-proportions",
                           "part-proportions",
                           "balance-speed",
                           "balance-bent-legs"})
    for (const double value : {0.0, -1.0, kNan})
      check_refused<TrackFitSettings>(name, value, "above 0");
  check_refused<TrackFitSettings>("roughly", 0, "above 0");
  check_refused<TrackFitSettings>("likeness", 1, "at least 0 and below 1");
  check_refused<TrackFitSettings>("exact-likeness", 1, "at least 0 and below 1");
  check_refused<TrackFitSettings>("noise-lasts", -0.01, "at least 0");
  check_refused<TrackFitSettings>("draws-noise-lasts", -0.01, "at least 0");
  check_refused<TrackFitSettings>("exact", 0, "above 0 and at most 1");
  check_refused<TrackFitSettings>("exact", 1.01, "above 0 and at most 1");
  check_refused<TrackFitSettings>("exact-cost", 1, "above 1");
  check_accepted<TrackFitSettings>("exact", 1);
  check_accepted<TrackFitSettings>("likeness", 0);
  check_accepted<TrackFitSettings>("exact-likeness", 0);
  check_accepted<TrackFitSettings>("noise-lasts", 0);
}
