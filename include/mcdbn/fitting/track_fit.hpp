// The room fitting: poses that are likely beforehand meet the 2D track that shows them.
// It uses features. Its door is fit_to_track; behind it: root paths, one problem for all frames of
// a clip, its costs; Ceres is included here alone. Add here: a cost, as a file of terms/ and lines
// in window_problem.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/features/modalities.hpp"

namespace mcdbn {

/// What is likely of each pose of a clip before its track is looked at: a normal distribution for
/// each frame and feature. It is all that the fit knows of a network. Standardized 3D features,
/// [frames x Modalities::pose_scale.output_dimension()] both.
struct PosePrior {
  MatrixF mean;
  /// Standard deviation, finite and not negative; 0 x 0: not known, and the settings' typical
  /// ones are taken. Those of height and the root's position are not used.
  MatrixF deviation;

  PosePrior() = default;
  /// A mean alone, without a deviation, where a method answers poses and no more.
  PosePrior(MatrixF mean_, MatrixF deviation_ = {})  // NOLINT(google-explicit-constructor)
      : mean(std::move(mean_)), deviation(std::move(deviation_)) {}
  bool has_deviation() const { return deviation.size() > 0; }
};

/// What is known of a clip besides its track.
struct KnownOfClip {
  std::optional<Camera> camera;  ///< unset: the assumed one, the clip put at the origin
  /// The person's own; unset: the model's, and the fit allows for other proportions.
  std::optional<Skeleton> skeleton;
  AssumedView view = {};   ///< what is known of the camera that is assumed
  AssumedView found = {};  ///< what was found out of it besides; `view` holds
  /// Whether the joints are a detector's keypoints: they are taken for no better than usual.
  bool detected = false;
  /// Whether the skeleton is not given but was found, in another part of the clip: the fit keeps
  /// it, and draws allow for other proportions.
  bool skeleton_found = false;

  bool body_given() const { return skeleton.has_value() && !skeleton_found; }
  /// Whether the track can be an exact projection: of a known body, and no detector's.
  bool may_be_exact() const { return skeleton.has_value() && !detected; }

  /// The camera, or the one that is assumed for that track.
  Camera camera_of(const Track2d& track, const Modalities& modalities) const {
    return camera ? *camera : modalities.assumed_camera(assumed(), track.width_px, track.height_px);
  }
  /// What was given of the view, and what was found where nothing was.
  AssumedView assumed() const {
    AssumedView all = view;
    if (!all.pitch_deg) all.pitch_deg = found.pitch_deg;
    if (!all.roll_deg) all.roll_deg = found.roll_deg;
    if (!all.field_of_view_deg) all.field_of_view_deg = found.field_of_view_deg;
    return all;
  }
};

/// What the fit takes for likely: of the prior, of the track, of a camera, and of a body that
/// moves. Chosen on clips of training people with other bodies and detector-like tracks, and on the
/// exact projections of the same: six CMU walks, of a model of walks and of a general one;
/// `likeness`, `lasting`, `outlier`, `proportions` and those after it, `roll` and `focal` on seven
/// CMU clips and twelve of Bandai's training halves, of the general model, which never saw
/// Bandai's; `exact`, `exact_cost` and `alternatives` on the exact projections of the same;
/// `exact_likeness`, `measured_lasting` and `measured_caution` on fourteen others of CMU's and 24
/// of Bandai's, exact and with noise of 2 and 5 px; `spread` and `draws-noise-lasts` on eleven of
/// CMU's, detector-like, exact, with noise of 5 px and with joints missing.
struct TrackFitSettings {
  double turn_deg = 9;
  double likeness = 0.6;
  double lasting_s = 0.1;
  double measured_lasting_s = 0.2;
  double measured_caution = 1.7;
  double exact = 0.3;
  double exact_likeness = 0.3;
  double exact_noise_px = 0.02;
  double exact_cost = 1.5;
  double root_m_s2 = 3;
  double detector = 0.009;
  double noise_lasts_s = 0.35;
  double caution = 2;
  double outlier = 4;
  double proportions = 0.5;
  double arm_proportions = 0.15;
  double leg_proportions = 0.06;
  double part_proportions = 0.1;
  double people = 0.1;
  double footing_m_s = 0.5;
  double ground_m = 0.05;
  double step_s = 0.5;
  double pitch_deg = 10;
  double roll_deg = 8;
  double balance_deg = 5;
  double balance_speed_m_s = 1.5;
  double balance_bent_legs = 0.2;
  double focal = 0.1;
  double roughly_s = 0.1;
  std::size_t solutions = 5;
  std::size_t alternatives = 4;
  double spread = 1.2;
  double draws_noise_lasts_s = 10;

  /// Metres are those of a 1.7 m body.
  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"turn", above(0), "degrees",
                  "standard deviation of an orientation about each axis where the prior gives none "
                  "or less"},
          self.turn_deg);
    // At 1 a joint would turn with its parent and no other way.
    visit(Setting{"likeness", share_below_one(), "",
                  "correlation of what is wrong with an orientation with its parent's"},
          self.likeness);
    visit(Setting{"lasting", above(0), "seconds",
                  "how long the prior's errors last: frames so near are one observation"},
          self.lasting_s);
    visit(Setting{"measured-lasting", above(0), "seconds",
                  "the same where a solution measured the noise: of a known body that no detector "
                  "saw"},
          self.measured_lasting_s);
    // Errors that last longer than that are there, too. A detector's hide them.
    visit(
        Setting{"exact", above(0, 1), "",
                "how much the prior's mean counts where rays are exact, of what it does elsewhere"},
        self.exact);
    visit(Setting{"exact-likeness", share_below_one(), "",
                  "the likeness where a track of a known body shows no noise itself"},
          self.exact_likeness);
    visit(Setting{"exact-noise", above(0), "px",
                  "noise that even exact rays are taken to have: what is left of rounding"},
          self.exact_noise_px);
    visit(Setting{"exact-cost", above(1), "",
                  "how many times the energy may become by a third of the noise: what becomes more "
                  "has noise"},
          self.exact_cost);
    visit(
        Setting{
            "root", above(0), "m/s2",
            "deviation of the root's acceleration from the prior's, where that has none or less"},
        self.root_m_s2);
    visit(Setting{"detector", above(0), "",
                  "how far off detectors are for longer than a frame, as a share of the body's "
                  "height"},
          self.detector);
    visit(Setting{"noise-lasts", at_least(0), "seconds", "for how long they are"},
          self.noise_lasts_s);
    visit(Setting{"caution", above(0), "",
                  "how many times the noise that is new in each frame it is taken to be"},
          self.caution);
    visit(Setting{"measured-caution", above(0), "", "the same where a solution measured the noise"},
          self.measured_caution);
    visit(Setting{"outlier", above(0), "",
                  "from so many deviations on a ray counts less and less (Cauchy): it shows "
                  "something else"},
          self.outlier);
    visit(
        Setting{
            "proportions", above(0), "",
            "deviation of the logarithm of a bone's length from the usual, where the person's own "
            "is not known: people, and where a detector sees the joints between them"},
        self.proportions);
    visit(Setting{"arm-proportions", above(0), "", "the same of upper arms and forearms"},
          self.arm_proportions);
    // Legs tell how large the person is, and so how far away.
    visit(Setting{"leg-proportions", above(0), "", "the same of thighs and shanks"},
          self.leg_proportions);
    visit(Setting{"part-proportions", above(0), "",
                  "the same of all bones where no frame shows a leg: nothing else shows how large "
                  "the person is"},
          self.part_proportions);
    visit(Setting{"people", above(0), "",
                  "the same of people alone: how far draws without a track's fit stray"},
          self.people);
    visit(Setting{"footing", above(0), "m/s", "how fast a foot that stands slips"},
          self.footing_m_s);
    visit(Setting{"roughly", above(0), "seconds",
                  "between the frames of the first solution, which the others start from"},
          self.roughly_s);
    visit(
        Setting{"solutions", at_least(0), "",
                "of all frames at most, after that one; each with the noise and the standing feet "
                "that the one before found"},
        self.solutions);
    visit(Setting{"alternatives", at_least(0), "",
                  "rounds at most in which limbs are tried on other sides in depth, where rays are "
                  "exact"},
          self.alternatives);
    visit(Setting{"spread", above(0), "",
                  "how many times wider the posterior is drawn than its equations make it"},
          self.spread);
    visit(Setting{"draws-noise-lasts", at_least(0), "seconds",
                  "as noise-lasts, for draws: a detector's error that passes makes the likeliest "
                  "motion better, and would make it surer than it is"},
          self.draws_noise_lasts_s);
    visit(Setting{"ground", above(0), "m",
                  "deviation of a standing foot's height above the clip's ground"},
          self.ground_m);
    visit(
        Setting{"step", above(0), "seconds", "in which all heights of a foot are one observation"},
        self.step_s);
    visit(Setting{"pitch", above(0), "degrees",
                  "deviation of a camera's pitch where it is not given: by hand, from a stand, a "
                  "ceiling"},
          self.pitch_deg);
    visit(Setting{"roll", above(0), "degrees",
                  "of its roll: held by hand, or a tripod that is not level"},
          self.roll_deg);
    visit(Setting{"balance", above(0), "degrees",
                  "deviation of the body's middle from straight above the feet, on average"},
          self.balance_deg);
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
            "focal", above(0), "",
            "deviation of the logarithm of a camera's focal length where it is not given; cameras "
            "differ by more, but one that gives way further follows the pose's errors"},
        self.focal);
  }
};

/// Motions that are asked for besides the likeliest, as likely as the posterior has them.
struct PosteriorDraws {
  std::size_t count = 0;
  std::uint64_t seed = 1;
};

/// A motion that meets its track.
struct FittedClip {
  Motion motion;  ///< at the model's rate; on the model's skeleton with the lengths that were
                  ///< found, if none was known
  Track2d shown;  ///< all its joints as the camera sees them; image size as the track's
  Camera camera;  ///< that sees `motion` so, in the skeleton's file units
  AssumedView view = {};  ///< of it, where none was known
  /// Whether the prior's mean does not match what the camera shows: the root started from how large
  /// body and image are, and the motion may be far off.
  bool placed_by_size = false;
  /// −log of how likely the motion is given prior and track, but for a constant: of two readings of
  /// a track in which the same joints are seen, that of the lower energy is the likelier. 0 without
  /// settings.
  double energy = 0;
  std::vector<Motion> draws =
      {};  ///< as `motion`, of bodies of their own if the skeleton is not known
};

/// The likeliest motion given a prior and the 2D track: one maximum a posteriori problem for the
/// clip's orientations, its root, and, without `known.skeleton`, the lengths of its bones, left and
/// right alike (docs/concepts.md, The fit). Without settings only the root is put where the track
/// shows it. Without a camera only the path's shape is known: it
/// starts above the origin, at the features' height.
/// @param features what decodes features to poses, and the joints to look at
/// @param track at the model's rate, as many frames as the prior; joined by name
/// @param settings unset: orientations stay as the prior's mean has them, and draws are what the
///        prior alone leaves open
/// @param draws for these a detector's lasting error lasts throughout, and without settings an
///        orientation's deviation is the prior's, however small: the likeliest motion and its
///        uncertainty take different settings
/// @throws ShapeError; InputError if the skeleton lacks a joint of the model, no frame shows enough
///         joints, or a deviation is negative or not finite
FittedClip fit_to_track(const PosePrior& prior, const Modalities& features, const Track2d& track,
                        const KnownOfClip& known, const std::optional<TrackFitSettings>& settings,
                        const PosteriorDraws& draws = {});

}  // namespace mcdbn
