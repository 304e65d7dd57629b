// The settings of the fit: defaults and ranges.

#include <doctest/doctest.h>

#include "base/settings_table.hpp"
#include "mcdbn/fitting/track_fit_settings.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("track fit settings: every one has its default, its own name and its own member") {
  using S = TrackFitSettings;
  const std::vector<Expected<S>> table = {
      {"orientation-deviation", [](S& s) { return at(s.orientation_deviation_deg); }, "9"},
      {"parent-correlation", [](S& s) { return at(s.parent_correlation); }, "0.6"},
      {"prior-error-time", [](S& s) { return at(s.prior_error_time_s); }, "0.1"},
      {"measured-prior-error-time", [](S& s) { return at(s.measured_prior_error_time_s); }, "0.2"},
      {"measured-noise-factor", [](S& s) { return at(s.measured_noise_factor); }, "1.7"},
      {"exact-prior-weight", [](S& s) { return at(s.exact_prior_weight); }, "0.3"},
      {"exact-parent-correlation", [](S& s) { return at(s.exact_parent_correlation); }, "0.3"},
      {"least-noise", [](S& s) { return at(s.least_noise_px); }, "0.02"},
      {"exact-energy-ratio", [](S& s) { return at(s.exact_energy_ratio); }, "1.5"},
      {"root", [](S& s) { return at(s.root_m_s2); }, "3"},
      {"detector-noise", [](S& s) { return at(s.detector_noise_heights); }, "0.009"},
      {"detector-noise-time", [](S& s) { return at(s.detector_noise_time_s); }, "0.35"},
      {"noise-factor", [](S& s) { return at(s.noise_factor); }, "2"},
      {"outlier", [](S& s) { return at(s.outlier_deviations); }, "4"},
      {"bone-log-deviation", [](S& s) { return at(s.bone_log_deviation); }, "0.5"},
      {"arm-log-deviation", [](S& s) { return at(s.arm_log_deviation); }, "0.15"},
      {"leg-log-deviation", [](S& s) { return at(s.leg_log_deviation); }, "0.06"},
      {"partial-body-log-deviation", [](S& s) { return at(s.partial_body_log_deviation); }, "0.1"},
      {"people-log-deviation", [](S& s) { return at(s.people_log_deviation); }, "0.1"},
      {"planted-foot-speed", [](S& s) { return at(s.planted_foot_speed_m_s); }, "0.5"},
      {"ground-deviation", [](S& s) { return at(s.ground_deviation_m); }, "0.05"},
      {"ground-observation", [](S& s) { return at(s.ground_observation_s); }, "0.5"},
      {"pitch-deviation", [](S& s) { return at(s.pitch_deviation_deg); }, "10"},
      {"roll-deviation", [](S& s) { return at(s.roll_deviation_deg); }, "8"},
      {"balance-deviation", [](S& s) { return at(s.balance_deviation_deg); }, "5"},
      {"balance-speed", [](S& s) { return at(s.balance_speed_m_s); }, "1.5"},
      {"balance-bent-legs", [](S& s) { return at(s.balance_bent_legs); }, "0.2"},
      {"focal-log-deviation", [](S& s) { return at(s.focal_log_deviation); }, "0.1"},
      {"first-solution-step", [](S& s) { return at(s.first_solution_step_s); }, "0.1"},
      {"most-solutions", [](S& s) { return at(s.most_solutions); }, "5"},
      {"most-alternatives", [](S& s) { return at(s.most_alternatives); }, "4"},
      {"draw-width-factor", [](S& s) { return at(s.draw_width_factor); }, "1.2"},
      {"draws-noise-time", [](S& s) { return at(s.draws_noise_time_s); }, "10"}};
  check_table(table);
  CHECK(member_count<S>() == table.size());
}

TEST_CASE("track fit settings: deviations are above 0, a correlation below 1") {
  for (const char* name : {"orientation-deviation",
                           "prior-error-time",
                           "root",
                           "detector-noise",
                           "noise-factor",
                           "bone-log-deviation",
                           "people-log-deviation",
                           "planted-foot-speed",
                           "draw-width-factor",
                           "outlier",
                           "ground-deviation",
                           "ground-observation",
                           "pitch-deviation",
                           "roll-deviation",
                           "balance-deviation",
                           "focal-log-deviation",
                           "least-noise",
                           "measured-prior-error-time",
                           "measured-noise-factor",
                           "arm-log-deviation",
                           "leg-log-deviation",
                           "partial-body-log-deviation",
                           "balance-speed",
                           "balance-bent-legs"})
    for (const double value : {0.0, -1.0, kNan})
      check_refused<TrackFitSettings>(name, value, "above 0");
  check_refused<TrackFitSettings>("first-solution-step", 0, "above 0");
  check_refused<TrackFitSettings>("parent-correlation", 1, "at least 0 and below 1");
  check_refused<TrackFitSettings>("exact-parent-correlation", 1, "at least 0 and below 1");
  check_refused<TrackFitSettings>("detector-noise-time", -0.01, "at least 0");
  check_refused<TrackFitSettings>("draws-noise-time", -0.01, "at least 0");
  check_refused<TrackFitSettings>("exact-prior-weight", 0, "above 0 and at most 1");
  check_refused<TrackFitSettings>("exact-prior-weight", 1.01, "above 0 and at most 1");
  check_refused<TrackFitSettings>("exact-energy-ratio", 1, "above 1");
  check_accepted<TrackFitSettings>("exact-prior-weight", 1);
  check_accepted<TrackFitSettings>("parent-correlation", 0);
  check_accepted<TrackFitSettings>("exact-parent-correlation", 0);
  check_accepted<TrackFitSettings>("detector-noise-time", 0);
}
