#pragma once

#include <cstddef>

#include "mcdbn/base/settings.hpp"

namespace mcdbn {

/// What the fit takes for likely: of the prior, of the track, of a body that moves, and of a camera
/// (docs/fit_settings.md). Chosen on clips of training people with other bodies and detector-like
/// tracks, and on the exact projections of the same: six CMU walks, of a model of walks and of a
/// general one. `parent_correlation`, `prior_error_time`, `outlier_deviations`, people, planted
/// feet and ground, `roll_deviation` and `focal_log_deviation` on seven CMU clips and twelve of
/// Bandai's training halves, of the general model, which never saw Bandai's; bones, `balance_speed`
/// and `balance_bent_legs` on 37 and 24 such clips, and on some whose legs are hidden or who sit;
/// `exact_prior_weight`, `exact_energy_ratio` and `most_alternatives` on the exact projections of
/// the same; `exact_parent_correlation`, `measured_prior_error_time` and `measured_noise_factor` on
/// fourteen others of CMU's and 24 of Bandai's, exact and with noise of 2 and 5 px;
/// `draw_width_factor` and `draws_noise_time` on eleven of CMU's, detector-like, exact, with noise
/// of 5 px and with joints missing.
struct TrackFitSettings {
  // The prior:
  double orientation_deviation_deg = 9;
  double parent_correlation = 0.6;
  double prior_error_time_s = 0.1;
  double measured_prior_error_time_s = 0.2;
  double exact_prior_weight = 0.3;
  double exact_parent_correlation = 0.3;
  double root_m_s2 = 3;
  // The track's noise:
  double least_noise_px = 0.02;
  double exact_energy_ratio = 1.5;
  double detector_noise_heights = 0.009;
  double detector_noise_time_s = 0.35;
  double noise_factor = 2;
  double measured_noise_factor = 1.7;
  double outlier_deviations = 4;
  // The body and its feet:
  double bone_log_deviation = 0.5;
  double arm_log_deviation = 0.15;
  double leg_log_deviation = 0.06;
  double partial_body_log_deviation = 0.1;
  double people_log_deviation = 0.1;
  double planted_foot_speed_m_s = 0.5;
  double ground_deviation_m = 0.05;
  double ground_observation_s = 0.5;
  // The camera:
  double pitch_deviation_deg = 10;
  double roll_deviation_deg = 8;
  double balance_deviation_deg = 5;
  double balance_speed_m_s = 1.5;
  double balance_bent_legs = 0.2;
  double focal_log_deviation = 0.1;
  // Solutions and draws:
  double first_solution_step_s = 0.1;
  std::size_t most_solutions = 5;
  std::size_t most_alternatives = 4;
  double draw_width_factor = 1.2;
  double draws_noise_time_s = 10;

  /// Metres are those of a 1.7 m body.
  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit_prior(self, visit);
    visit_noise(self, visit);
    visit_body(self, visit);
    visit_camera(self, visit);
    visit_solutions(self, visit);
  }

 private:
  template <typename Self, typename Visit>
  static void visit_prior(Self& self, const Visit& visit) {
    visit(Setting{"orientation-deviation", above(0), "degrees",
                  "standard deviation of an orientation about each axis where the prior gives none "
                  "or less"},
          self.orientation_deviation_deg);
    // At 1 a joint would turn with its parent and no other way.
    visit(Setting{"parent-correlation", share_below_one(), "",
                  "correlation of an orientation's error with its parent's"},
          self.parent_correlation);
    visit(Setting{"prior-error-time", above(0), "seconds",
                  "correlation time of the prior's errors: frames within it count as one "
                  "observation"},
          self.prior_error_time_s);
    visit(
        Setting{"measured-prior-error-time", above(0), "seconds",
                "as prior-error-time, where a solution measured the noise: of a known body that no "
                "detector saw"},
        self.measured_prior_error_time_s);
    // Errors that last longer than that are there, too. A detector's hide them.
    visit(Setting{"exact-prior-weight", above(0, 1), "",
                  "weight of the prior's mean where rays are exact, relative to elsewhere"},
          self.exact_prior_weight);
    visit(Setting{"exact-parent-correlation", share_below_one(), "",
                  "as parent-correlation, where a track of a known body shows no noise itself"},
          self.exact_parent_correlation);
    visit(
        Setting{
            "root", above(0), "m/s2",
            "deviation of the root's acceleration from the prior's, where that has none or less"},
        self.root_m_s2);
  }

  template <typename Self, typename Visit>
  static void visit_noise(Self& self, const Visit& visit) {
    visit(Setting{"least-noise", above(0), "px",
                  "noise that even exact rays are taken to have: what is left of rounding"},
          self.least_noise_px);
    visit(Setting{"exact-energy-ratio", above(1), "",
                  "largest ratio of the energies with a third of the noise and with all of it; "
                  "above it the track is noisy, not exact"},
          self.exact_energy_ratio);
    visit(Setting{"detector-noise", above(0), "body heights",
                  "deviation of a detector's errors that last for longer than a frame"},
          self.detector_noise_heights);
    visit(Setting{"detector-noise-time", at_least(0), "seconds", "how long such an error lasts"},
          self.detector_noise_time_s);
    visit(Setting{"noise-factor", above(0), "",
                  "factor on the noise that is new in each frame, as a margin"},
          self.noise_factor);
    visit(Setting{"measured-noise-factor", above(0), "",
                  "as noise-factor, where a solution measured the noise"},
          self.measured_noise_factor);
    visit(Setting{"outlier", above(0), "deviations",
                  "Cauchy scale: beyond so many deviations a ray loses weight"},
          self.outlier_deviations);
  }

  template <typename Self, typename Visit>
  static void visit_body(Self& self, const Visit& visit) {
    visit(
        Setting{
            "bone-log-deviation", above(0), "",
            "deviation of the logarithm of a bone's length from the usual, where the person's own "
            "is not known: people, and where a detector sees the joints between them"},
        self.bone_log_deviation);
    visit(Setting{"arm-log-deviation", above(0), "",
                  "as bone-log-deviation, of upper arms and forearms"},
          self.arm_log_deviation);
    // Legs tell how large the person is, and so how far away.
    visit(Setting{"leg-log-deviation", above(0), "", "as bone-log-deviation, of thighs and shanks"},
          self.leg_log_deviation);
    visit(
        Setting{
            "partial-body-log-deviation", above(0), "",
            "as bone-log-deviation, of all bones where no frame shows a leg: nothing else shows "
            "how large the person is"},
        self.partial_body_log_deviation);
    visit(Setting{"people-log-deviation", above(0), "",
                  "as bone-log-deviation, of people alone: for draws without a track's fit"},
          self.people_log_deviation);
    visit(Setting{"planted-foot-speed", above(0), "m/s", "how fast a foot that stands slips"},
          self.planted_foot_speed_m_s);
    visit(Setting{"ground-deviation", above(0), "m",
                  "deviation of a standing foot's height above the clip's ground"},
          self.ground_deviation_m);
    visit(Setting{"ground-observation", above(0), "seconds",
                  "time within which a foot's heights count as one observation"},
          self.ground_observation_s);
  }

  template <typename Self, typename Visit>
  static void visit_camera(Self& self, const Visit& visit) {
    visit(Setting{"pitch-deviation", above(0), "degrees",
                  "deviation of a camera's pitch where it is not given: by hand, from a stand, a "
                  "ceiling"},
          self.pitch_deviation_deg);
    visit(Setting{"roll-deviation", above(0), "degrees",
                  "standard deviation of its roll: hand-held, or a tripod that is not level"},
          self.roll_deviation_deg);
    visit(Setting{"balance-deviation", above(0), "degrees",
                  "deviation of the body's middle from straight above the feet, on average"},
          self.balance_deviation_deg);
    // Who runs leans, and feet trail.
    visit(Setting{"balance-speed", above(0), "m/s",
                  "how fast a body moves where that is twice as uncertain"},
          self.balance_speed_m_s);
    // Who sits has the feet in front of the body.
    visit(Setting{"balance-bent-legs", above(0), "",
                  "by what share of a leg's length the ankles are nearer to the hips where it is "
                  "twice as uncertain, too"},
          self.balance_bent_legs);
    visit(
        Setting{
            "focal-log-deviation", above(0), "",
            "deviation of the logarithm of a camera's focal length where it is not given; cameras "
            "differ by more, but a wider prior lets the focal length absorb errors of the pose"},
        self.focal_log_deviation);
  }

  template <typename Self, typename Visit>
  static void visit_solutions(Self& self, const Visit& visit) {
    visit(Setting{"first-solution-step", above(0), "seconds",
                  "time between the frames of the first solution, which the others start from"},
          self.first_solution_step_s);
    visit(Setting{"most-solutions", at_least(0), "",
                  "largest number of solutions of all frames after the first; each uses the noise "
                  "and the standing feet that the one before found"},
          self.most_solutions);
    visit(
        Setting{"most-alternatives", at_least(0), "",
                "largest number of rounds in which limbs are tried on other sides in depth, where "
                "rays are exact"},
        self.most_alternatives);
    visit(Setting{"draw-width-factor", above(0), "", "factor on the posterior's width for draws"},
          self.draw_width_factor);
    visit(Setting{"draws-noise-time", at_least(0), "seconds",
                  "as detector-noise-time, for draws: a detector's error that passes makes the "
                  "likeliest motion better, and would make it surer than it is"},
          self.draws_noise_time_s);
  }
};

}  // namespace mcdbn
