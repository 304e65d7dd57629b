#include <doctest/doctest.h>

#include "corpus/augmented_views.hpp"
#include "corpus/corpus_config.hpp"
#include "corpus/held_out_person.hpp"
#include "corpus/people.hpp"
#include "corpus/training_files.hpp"
#include "mcdbn/corpus/clip.hpp"

namespace augmented_views_contents_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

CorpusConfig settings() {
  CorpusConfig config;
  config.seed = 5;
  config.fps = 24.0;
  config.camera.azimuth_deg = -35.0;
  config.augment.views = 3;
  config.augment.missing = 0.5;
  config.augment.azimuth_deg = 8.0;
  return config;
}

const std::vector<WalkFile> kWalks{{1, 1, 60.0}, {2, 1, 48.0}, {1, 2, 30.0, 1.1}};

/// A clip of a body of three joints that turns, `frames` long at `fps`.
std::filesystem::path write_stick(const ScratchFolder& folder, int frames, double fps) {
  Motion motion;
  motion.frame_time_s = 1.0 / fps;
  motion.skeleton.joints.resize(3);
  for (int j = 0; j < 3; ++j) {
    Joint& joint = motion.skeleton.joints[static_cast<std::size_t>(j)];
    joint.name = fmt::format("Joint{}", j);
    joint.parent = j - 1;
    if (j > 0) joint.offset = {0, 40, 0};
    if (j == 0) joint.channels = {Channel::x_position, Channel::y_position, Channel::z_position};
    if (j < 2)
      for (const Channel axis : {Channel::z_rotation, Channel::x_rotation, Channel::y_rotation})
        joint.channels.push_back(axis);
  }
  motion.channels = MatrixD::Zero(frames, motion.skeleton.channel_count());
  for (int t = 0; t < frames; ++t)
    for (Eigen::Index c = 0; c < motion.channels.cols(); ++c)
      motion.channels(t, c) = 20.0 * std::sin(0.1 * t + static_cast<double>(c));
  const auto file = folder / fmt::format("stick_{}.bvh", frames);
  write_bvh(file, motion);
  return file;
}

}  // namespace

TEST_CASE(
    "augmented views are those of the keys behind one another, encoded by the model's scale") {
  const TrainingFiles walks(kWalks);
  const CorpusConfig config = settings();
  const Modalities modalities = make_training_set(walks.files(), config, nullptr).modalities;
  const TrainingSet views = make_augmented_views(walks.files(), modalities, config);
  REQUIRE(views.poses.size() == 9);
  REQUIRE(views.tracks.size() == 9);
  CHECK(views.people == std::vector<std::size_t>{0, 0, 0, 1, 1, 1, 0, 0, 0});
  REQUIRE(views.clips.size() == 9);
  bool unknown = false;
  for (std::uint32_t i = 0; i < 9; ++i) {
    CAPTURE(i);
    const auto& file = walks.files()[i / 3];
    const Motion raw = load_clip(file, {.fps = 0, .keep_first_frame = false});
    const AugmentedView view =
        augmented_view(raw, config.fps, config.camera, config.augment, {config.seed, i, 192, 0});
    const MatrixF track = modalities.encode_track(view.track, view.camera);
    unknown = unknown || track.array().isNaN().any();
    CHECK(views.tracks[i] ==
          track.array().isNaN().select(MatrixF::Zero(track.rows(), track.cols()), track));
    CHECK((views.tracks_seen.at(i).array() == 1.0F - track.array().isNaN().cast<float>()).all());
    CHECK(views.poses[i] == modalities.encode_pose(view.motion, view.camera.camera_from_world));
    CHECK(views.clips[i].path == identify_clip(file).path);
    for (std::uint32_t j = 0; j < i; ++j)
      CHECK((views.poses[i].rows() != views.poses[j].rows() || views.poses[i] != views.poses[j]));
  }
  CHECK(unknown);  // so that the case covers hidden limbs
  CorpusConfig all_seen = config;
  all_seen.augment.missing = 0;
  CHECK(make_augmented_views(walks.files(), modalities, all_seen).tracks_seen.empty());
  CHECK(views.modalities.fps == modalities.fps);
  CHECK(views.modalities.pose_scale.mean() == modalities.pose_scale.mean());
}

TEST_CASE("another seed, other views of every clip") {
  const TrainingFiles walks({{1, 1, 30.0, 1.0}, {2, 1, 30.0, 1.0}});
  CorpusConfig config = settings();
  const Modalities modalities = make_training_set(walks.files(), config, nullptr).modalities;
  const TrainingSet first = make_augmented_views(walks.files(), modalities, config);
  config.seed = 6;
  const TrainingSet second = make_augmented_views(walks.files(), modalities, config);
  for (std::size_t i = 0; i < first.poses.size(); ++i)
    CHECK((first.poses[i].rows() != second.poses[i].rows() || first.poses[i] != second.poses[i]));
}

TEST_CASE("there are fewer views of much data") {
  const ScratchFolder folder;
  // Together 66 976 frames at the model's rate: three views of each are just above 200 000.
  const std::vector<std::filesystem::path> files{write_stick(folder, 500, 0.5),
                                                 write_stick(folder, 840, 1.0)};
  CorpusConfig config;
  config.fps = 36.4;
  config.augment = {.views = 5, .mirror = false};
  const std::vector<std::filesystem::path> shortest{write_stick(folder, 60, 36.4)};
  const Modalities modalities = make_training_set(shortest, config, nullptr).modalities;
  CHECK(make_augmented_views(files, modalities, config).poses.size() == 2 * 2);
}

TEST_CASE("a person's views keep their tracks, poses, clips and numbers") {
  const TrainingFiles walks(kWalks);
  const CorpusConfig config = settings();
  const Modalities modalities = make_training_set(walks.files(), config, nullptr).modalities;
  const TrainingSet views = make_augmented_views(walks.files(), modalities, config);
  const TrainingSet one = views_of(views, 0), others = views_without(views, 0);
  REQUIRE(one.poses.size() == 6);
  REQUIRE(others.poses.size() == 3);
  const auto check = [&](const TrainingSet& set, std::size_t at, std::size_t from) {
    CHECK(set.poses[at] == views.poses[from]);
    CHECK(set.tracks[at] == views.tracks[from]);
    CHECK(set.tracks_seen.at(at) == views.tracks_seen.at(from));
    CHECK(set.clips[at].path == views.clips[from].path);
    CHECK(set.people[at] == views.people[from]);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    check(one, i, i);
    check(others, i, 3 + i);
    check(one, 3 + i, 6 + i);
  }
  CHECK(one.modalities.pose_scale.mean() == modalities.pose_scale.mean());
}

TEST_CASE("people are one person within a thousandth of every bone, and others beyond") {
  Skeleton body;
  body.joints.resize(3);
  body.joints[1].offset = {0, 50, 0};
  body.joints[2].offset = {0, 0, 20};
  const auto with = [&](double last) {
    Skeleton other = body;
    other.joints[2].offset = {0, 0, last};
    return other;
  };
  PeopleCount people;
  CHECK(people.number_of(body) == 0);
  CHECK(people.number_of(with(20.015)) == 0);
  CHECK(people.number_of(with(19.985)) == 0);
  CHECK(people.number_of(with(20.03)) == 1);
  CHECK(people.number_of(with(19.97)) == 2);
  Skeleton longer = body;
  longer.joints.resize(4);
  CHECK(people.number_of(longer) == 3);
  CHECK(people.number_of(body) == 0);
}

}  // namespace augmented_views_contents_test
