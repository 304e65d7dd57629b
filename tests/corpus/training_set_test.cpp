#include "mcdbn/corpus/training_set.hpp"
#include "corpus/corpus_config.hpp"
#include "mcdbn/camera/level_view.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "corpus/augmented_views.hpp"
#include "corpus/training_files.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "motion/mean_body.hpp"
#include "motion/mirror.hpp"
#include "motion/resample.hpp"

namespace training_set_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// 120 and 60 frames a second.
const std::vector<WalkFile> kWalks{{1, 1, 120.0}, {2, 1, 60.0}, {1, 2, 60.0, 1.2}};

CorpusConfig settings() {
  CorpusConfig config;
  config.seed = 41;
  config.fps = 24.0;
  config.camera.azimuth_deg = -35.0;
  config.camera.elevation_deg = 3.0;
  config.augment.views = 3;
  config.augment.missing = 0.6;
  config.augment.noise_px = 2.0;
  config.augment.azimuth_deg = 10.0;
  config.augment.turn_deg = 4.0;
  return config;
}

Motion raw_clip(const std::filesystem::path& file) {
  return load_clip(file, {.fps = 0, .keep_first_frame = false});
}

/// Clips of all files on `phases` grids each.
std::vector<Motion> clips_of(const TrainingFiles& walks, const CorpusConfig& config,
                             const std::vector<int>& phases) {
  std::vector<Motion> clips;
  for (std::size_t i = 0; i < walks.files().size(); ++i)
    for (int phase = 0; phase < phases[i]; ++phase)
      clips.push_back(
          resample(raw_clip(walks.files()[i]), config.fps, static_cast<double>(phase) / phases[i]));
  return clips;
}

struct Columns {
  MatrixD values;
  void add(const MatrixD& rows) {
    const MatrixD before = values;
    values.resize(before.rows() + rows.rows(), rows.cols());
    if (before.rows() > 0) values.topRows(before.rows()) = before;
    values.bottomRows(rows.rows()) = rows;
  }
};

/// Mean and deviation of every column over all rows that were added.
void check_scale(const Standardizer& scale, const MatrixD& values) {
  REQUIRE(scale.input_dimension() == values.cols());
  for (Eigen::Index c = 0; c < values.cols(); ++c) {
    double sum = 0, squares = 0, count = 0;
    for (Eigen::Index r = 0; r < values.rows(); ++r)
      if (!std::isnan(values(r, c))) {
        sum += values(r, c);
        ++count;
      }
    const double mean = sum / count;
    for (Eigen::Index r = 0; r < values.rows(); ++r)
      if (!std::isnan(values(r, c))) squares += (values(r, c) - mean) * (values(r, c) - mean);
    const double deviation = std::sqrt(squares / count);
    CAPTURE(c);
    CHECK(std::abs(scale.mean()[c] - mean) <= 1e-9 * (1.0 + std::abs(mean)));
    if (deviation > 1e-3) CHECK(scale.deviation()[c] == doctest::Approx(deviation).epsilon(1e-9));
  }
}

/// The whole of make_training_set once more: what is encoded, and what the scaling is fitted to.
void check_set(const TrainingFiles& walks, const CorpusConfig& config,
               const std::vector<int>& phases, int views, std::size_t directions = 1) {
  const TrainingSet set = make_training_set(walks.files(), config, nullptr);
  const Modalities& own = set.modalities;
  CHECK(own.fps == config.fps);
  CHECK(own.camera == config.camera);
  CHECK(own.level_view);
  CHECK(own.directions == directions);
  const auto level_track = [&](const Track2d& track, const Camera& camera) {
    return turn_track(track, camera, level_camera(camera, config.camera.field_of_view_deg));
  };
  const std::vector<Motion> clips = clips_of(walks, config, phases);
  REQUIRE(set.tracks.size() == directions * clips.size());
  REQUIRE(set.poses.size() == directions * clips.size());
  Columns tracks, poses;
  std::size_t frames = 0;
  for (std::size_t i = 0; i < set.poses.size(); ++i) {
    const Motion& clip = clips[i / directions];
    CameraPlacement placement = config.camera;
    placement.azimuth_deg +=
        360.0 / static_cast<double>(directions) * static_cast<double>(i % directions);
    const Camera camera = place_camera(clip, placement);
    const MatrixD track =
                      own.track_features.encode(level_track(project_motion(clip, camera), camera)),
                  pose = own.pose_features.encode(clip, level_rotation(camera.camera_from_world));
    CHECK(set.tracks[i] == own.track_scale.apply(track));
    CHECK(set.poses[i] == own.pose_scale.apply(pose));
    tracks.add(track);
    poses.add(pose);
    frames += static_cast<std::size_t>(clip.frames());
  }
  CHECK(set.frames() == frames);
  AugmentationSettings in_sight = config.augment;
  in_sight.missing = 0;
  in_sight.mirror = false;
  RandomKey key{config.seed, 0, 196, 0};
  for (const auto& file : walks.files())
    for (int i = 0; i < views; ++i, ++key.step) {
      const Motion raw = raw_clip(file);
      const AugmentedView view =
          augmented_view(config.augment.mirror && i % 2 == 1 ? mirrored(raw).value() : raw,
                         config.fps, config.camera, in_sight, key);
      tracks.add(own.track_features.encode(level_track(view.track, view.camera)));
      poses.add(
          own.pose_features.encode(view.motion, level_rotation(view.camera.camera_from_world)));
    }
  check_scale(own.track_scale, tracks.values);
  check_scale(own.pose_scale, poses.values);
  REQUIRE(set.clips.size() == walks.files().size());
  for (std::size_t i = 0; i < set.clips.size(); ++i) {
    CHECK(set.clips[i].path == identify_clip(walks.files()[i]).path);
    CHECK(set.clips[i].fingerprint == identify_clip(walks.files()[i]).fingerprint);
  }
}

}  // namespace

TEST_CASE("a training set: every clip encoded and scaled for itself and for its views") {
  const TrainingFiles walks(kWalks);
  CorpusConfig config = settings();
  for (const std::size_t views : {1, 9}) {  // four are for the scale
    config.augment.views = views;
    check_set(walks, config, {1, 1, 1}, 4);
  }
}

TEST_CASE("a training set: the model's body is the mean of its people's, each counted once") {
  const TrainingFiles walks({{1, 1}, {1, 2}, {2, 1}});
  const auto skeleton = [&](std::size_t file) { return raw_clip(walks.files()[file]).skeleton; };
  const auto bones = [](const Skeleton& of) {
    MatrixD offsets(of.joint_count(), 3);
    for (int j = 0; j < of.joint_count(); ++j)
      offsets.row(j) = of.joints[static_cast<std::size_t>(j)].offset.transpose();
    return offsets;
  };
  const auto trained = [&](std::size_t first, std::size_t count) {
    const std::vector<std::filesystem::path> files(walks.files().begin() + first,
                                                   walks.files().begin() + first + count);
    return bones(make_training_set(files, settings(), nullptr).modalities.pose_features.skeleton());
  };
  CHECK(trained(0, 3) == bones(mean_body({skeleton(0), skeleton(2)})));
  CHECK((trained(0, 3) - bones(skeleton(0))).norm() > 1e-3);
  CHECK(trained(0, 2) == bones(skeleton(0)));
}

TEST_CASE("a training set: what detectors see is scaled by their errors too") {
  const TrainingFiles walks(kWalks);
  CorpusConfig config = settings();
  config.augment.detector = 1;
  check_set(walks, config, {1, 1, 1}, 4);
}

TEST_CASE("a training set for the greedy stages alone is scaled by its clips alone") {
  const TrainingFiles walks(kWalks);
  CorpusConfig config = settings();
  config.with_views = false;
  check_set(walks, config, {1, 1, 1}, 0);
}

TEST_CASE("clips are taken on as many grids as were asked for and as their own rate allows") {
  const TrainingFiles walks(kWalks);
  CorpusConfig config = settings();
  config.with_views = false;
  config.phases = 3;  // 120 Hz has five source frames in one of 24 Hz, 60 Hz two
  check_set(walks, config, {3, 2, 2}, 0);
  config.phases = 5;
  check_set(walks, config, {5, 2, 2}, 0);
  config.fps = 30.0;  // exactly four and two
  config.phases = 9;
  check_set(walks, config, {4, 2, 2}, 0);
}

TEST_CASE("clips are seen from as many directions as were asked for, where there are no views") {
  const TrainingFiles walks(kWalks);
  CorpusConfig config = settings();
  config.directions = 4;
  check_set(walks, config, {1, 1, 1}, 4);  // views are from all around by themselves
  config.with_views = false;
  config.phases = 3;
  check_set(walks, config, {3, 2, 2}, 0, 4);
  using Numbers = std::vector<std::size_t>;
  config.phases = 1;
  config.directions = 2;
  const TrainingSet set = make_training_set(walks.files(), config, nullptr);
  CHECK(set.people == Numbers{0, 0, 1, 1, 0, 0});
  // A model that is trained on keeps its own.
  const auto clips = load_clips(walks.files(), config.keep_first_frame, nullptr);
  config.directions = 1;
  CHECK(encoded_training_set(clips, set.modalities, config, false).poses == set.poses);
}

TEST_CASE("a training set and views of it: people, and actions where those were given") {
  const TrainingFiles walks(kWalks);
  CorpusConfig config = settings();
  config.phases = 3;
  std::vector<LoadedClip> clips = load_clips(walks.files(), config.keep_first_frame, nullptr);
  const auto taken = [&](bool with_views) {
    return mcdbn::make_training_set(clips, config, config.seed, with_views);
  };
  const auto seen = [&] {
    return mcdbn::make_augmented_views(clips, taken(true).modalities, config, config.seed);
  };
  using Numbers = std::vector<std::size_t>;
  CHECK(taken(false).people == Numbers{0, 0, 0, 1, 1, 0, 0});  // on 3, 2 and 2 grids
  CHECK(taken(false).groups.empty());
  CHECK(taken(true).people == Numbers{0, 1, 0});  // views are of the clips themselves
  CHECK(seen().people == Numbers{0, 0, 0, 1, 1, 1, 0, 0, 0});
  CHECK(seen().groups.empty());
  clips[0].clip.action = "walk";
  clips[2].clip.action = "run";
  CHECK(taken(false).people == Numbers{0, 0, 0, 1, 1, 0, 0});
  CHECK(taken(false).groups == Numbers{0, 0, 0, 1, 1, 2, 2});
  CHECK(taken(true).groups == Numbers{0, 1, 2});
  CHECK(seen().groups == Numbers{0, 0, 0, 1, 1, 1, 2, 2, 2});
}

TEST_CASE("a leading calibration pose is dropped from clips and views, or kept") {
  const ScratchFolder folder;
  SynthesisOptions options;
  options.seconds = 1.5;
  Motion walk = synthesize(options);
  walk.channels.row(0).tail(walk.channels.cols() - 3).setZero();  // a rest pose before the walk
  REQUIRE(has_leading_calibration_pose(walk));
  const std::vector<std::filesystem::path> files{folder / "walk.bvh"};
  write_bvh(files.front(), walk);
  CorpusConfig config;
  config.augment = {.views = 2, .mirror = false};
  std::vector<std::string> notices;
  const TrainingSet without = make_training_set(files, config, &notices);
  CHECK(notices.size() == 1);
  const TrainingSet views_without = make_augmented_views(files, without.modalities, config);
  config.keep_first_frame = true;
  const TrainingSet with = make_training_set(files, config, nullptr);
  const TrainingSet views_with = make_augmented_views(files, without.modalities, config);
  CHECK(with.frames() == without.frames() + 1);
  CHECK(views_with.frames() > views_without.frames());
}

TEST_CASE("another seed, another scaling; no clips, no training set") {
  const TrainingFiles walks({{1, 1, 30.0}});
  CorpusConfig config = settings();
  const RowVectorD mean =
      make_training_set(walks.files(), config, nullptr).modalities.pose_scale.mean();
  CHECK(mean == make_training_set(walks.files(), config, nullptr).modalities.pose_scale.mean());
  config.seed = 42;
  CHECK(mean != make_training_set(walks.files(), config, nullptr).modalities.pose_scale.mean());
  CHECK_THROWS_AS(make_training_set({}, config, nullptr), InputError);
}

}  // namespace training_set_test
