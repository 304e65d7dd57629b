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
  /// Standard deviation, finite and not negative; 0 x 0: nobody knows it, and the settings' typical
  /// ones are taken. Height and the root's position are not asked.
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
  AssumedView view = {};  ///< what is known of the camera that is assumed

  /// The camera, or the one that is assumed for that track.
  Camera camera_of(const Track2d& track, const Modalities& modalities) const {
    return camera ? *camera : modalities.assumed_camera(view, track.width_px, track.height_px);
  }
};

/// What the fit takes for likely: of the prior, of the track, and of a body that moves. Chosen on
/// six CMU walks of six people who were trained on, with other bodies and detector-like tracks,
/// of a model of walks and of a general one, and on the exact projections of the same; `doubt` on
/// these and seven training clips of other actions, of the general model; `spread` on eleven of
/// them, detector-like, exact, with noise of 5 px and with joints missing.
struct TrackFitSettings {
  double turn_deg = 9;
  double doubt = 0.4;
  double likeness = 0.75;
  double lasting_s = 0.17;
  double root_m_s2 = 3;
  double detector = 0.009;
  double noise_lasts_s = 0.35;
  double caution = 2;
  double proportions = 0.1;
  double footing_m_s = 0.5;
  std::size_t solutions = 5;
  double spread = 1.3;

  /// Metres are those of a 1.7 m body.
  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"turn", above(0), "degrees",
                  "standard deviation of an orientation about each axis where the prior says none"},
          self.turn_deg);
    visit(
        Setting{"doubt", within(0, 1), "",
                "how many times larger than that, as a power, an orientation's deviation is taken "
                "to be where the prior says a larger one: 0 not at all, 1 as it says"},
        self.doubt);
    // At 1 a joint would turn with its parent and no other way.
    visit(Setting{"likeness", share_below_one(), "",
                  "correlation of what is wrong with an orientation with its parent's"},
          self.likeness);
    visit(Setting{"lasting", above(0), "seconds",
                  "how long the prior's errors last: frames so near are one witness"},
          self.lasting_s);
    visit(Setting{"root", above(0), "m/s2",
                  "deviation of the root's acceleration from the prior's, where that says none"},
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
    visit(Setting{"proportions", above(0), "",
                  "deviation of the logarithm of a bone's length from the model's, for a skeleton "
                  "that is not the person's own"},
          self.proportions);
    visit(Setting{"footing", above(0), "m/s", "how fast a foot that stands slips"},
          self.footing_m_s);
    visit(Setting{"solutions", at_least(1), "",
                  "at most, each with the noise and the standing feet that the one before tells"},
          self.solutions);
    visit(Setting{"spread", above(0), "",
                  "how many times wider the posterior is drawn than its equations make it"},
          self.spread);
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
  std::vector<Motion> draws =
      {};  ///< as `motion`, of bodies of their own if the skeleton is not known
};

/// The likeliest motion given a prior and the 2D track: one maximum a posteriori problem for the
/// clip's orientations, its root, and, without `known.skeleton`, the lengths of its bones, left and
/// right alike (docs/concepts.md, The fit). Without settings only the root is put where the track
/// shows it. Without a camera only the path's shape is known: it
/// starts above the origin, at the height that the features say.
/// @param features what decodes features to poses, and the joints to look at
/// @param track at the model's rate, as many frames as the prior; joined by name
/// @param settings unset: orientations stay as the prior's mean has them, and draws are what the
///        prior alone leaves open
/// @param draws for these an orientation's deviation is what the prior says, and a detector's
///        lasting error lasts throughout: what is likeliest and how sure it is are not told by the
///        same settings
/// @throws ShapeError; InputError if the skeleton lacks a joint of the model, no frame shows enough
///         joints, or a deviation is negative or not finite
FittedClip fit_to_track(const PosePrior& prior, const Modalities& features, const Track2d& track,
                        const KnownOfClip& known, const std::optional<TrackFitSettings>& settings,
                        const PosteriorDraws& draws = {});

}  // namespace mcdbn
