// The room corpus: clips as training sequences: reading, views, people.
// It uses formats, features, synthesis.
// Add here: another way to see or change clips before training: beside augmentation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mcdbn/corpus/augmentation.hpp"
#include "mcdbn/corpus/clip_store.hpp"
#include "mcdbn/features/modalities.hpp"
#include "mcdbn/motion/frame_rate.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {

/// The skeleton that a model learns.
enum class SkeletonUse {
  shared,    ///< the clips' own where they share one, by joint names; else the humanoid
  own,       ///< the clips' own
  humanoid,  ///< the canonical humanoid, onto which every clip is brought
};

/// How clips become training sequences.
struct CorpusSettings {
  double fps = 30.0;
  std::size_t phases = 1;
  std::size_t directions = 1;
  bool keep_first_frame = false;
  SkeletonUse skeleton = SkeletonUse::shared;  ///< no number: a choice of load_training_clips
  JointMap joint_map = {};                     ///< no number: roles of clips' joints, given by hand
  AugmentationSettings augment;
  CameraPlacement camera;

  /// @throws ConfigError naming the setting that is out of range
  void validate() const { check_settings(*this); }

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"fps", kFrameRate_hz, "Hz", "frame rate of the model; clips are resampled to it"},
          self.fps);
    visit(
        Setting{"phases", within(1, 1000), "resamplings",
                "shifted resamplings of each clip when nothing is fine-tuned, at most clip rate / "
                "fps: they use the frames in between"},
        self.phases);
    visit(Setting{"directions", Modalities::kDirections, "directions",
                  "camera directions, evenly around, that each clip is projected from when nothing "
                  "is fine-tuned"},
          self.directions);
    visit(Setting{"keep-first-frame", on_or_off(), "", "keep a leading calibration pose"},
          self.keep_first_frame);
    visit_group("augment", self.augment, visit);
    visit_group("camera", self.camera, visit);
  }
};

/// Synchronized clips of both modalities, standardized: [frames x dimension] each.
struct TrainingSet {
  Modalities modalities;
  std::vector<MatrixF> tracks;  ///< 2D
  std::vector<MatrixF> poses;   ///< 3D
  /// All files as they were read; of augmented views, each view's.
  std::vector<TrainingClip> clips;
  /// Person of each of `poses`, counted from 0.
  std::vector<std::size_t> people;
  /// What was seen of each of `tracks`, 1, and what was not, 0, where the track is at its mean;
  /// empty where everything was.
  std::vector<MatrixF> tracks_seen;
  /// Person and action of each of `poses`, as one number; empty where no actions are given.
  std::vector<std::size_t> groups = {};
  /// Poses for views of the clips with poses that no clip holds; none: there are no such views.
  std::shared_ptr<const PosePool> new_poses = {};
  std::size_t frames() const;
};

/// Resamples each clip, without views on `phases` shifted grids, projects it through the camera,
/// without views from `directions` all around, and learns the features and their scaling. Of more
/// than some two hours pieces stand for all (clip_pieces.hpp).
/// @param clips at their own rate (load_clips)
/// @param with_views the scaling is learnt from augmented views, too (make_augmented_views)
/// @param held_out a person, as the set numbers them, of whose clips no new poses are made
/// @throws InputError
TrainingSet make_training_set(const ClipStore& clips, const CorpusSettings& settings,
                              std::uint64_t seed, bool with_views,
                              std::optional<std::size_t> held_out = {});

/// As make_training_set(), with the features and the scaling of `modalities` instead of new ones.
/// @param with_views new poses are made ready, if the settings ask for such
/// @param held_out a person, as the set numbers them, of whose clips no new poses are made
/// @throws InputError if a clip lacks a joint of theirs
TrainingSet encoded_training_set(const ClipStore& clips, const Modalities& modalities,
                                 const CorpusSettings& settings, bool with_views,
                                 std::optional<std::size_t> held_out = {});

}  // namespace mcdbn
