// A track frame by frame: what comes back, when, and how near it is to the whole clip's answer.

#include "mcdbn/motion_model/live_regeneration.hpp"

#include <doctest/doctest.h>
#include <malloc.h>

#include <chrono>
#include <thread>

#include "camera/projected_keypoints.hpp"
#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"
#include "motion/body_size.hpp"
#include "motion_model/live_networks.hpp"
#include "motion_model/live_output.hpp"
#include "motion_model/live_scene.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// A detector's keypoints, in place of the model's joints.
Track2d coco_keypoints_of(const LiveScene& scene) {
  return project_keypoints(scene.clip, skeleton_roles(scene.clip.skeleton),
                           joint_set("COCO_17").keypoints, scene.camera);
}

/// Bytes that are taken, once no thread takes or gives back any more.
double memory_at_rest() {
  std::size_t before = 0, now = mallinfo2().uordblks;
  for (int tries = 0; now != before && tries < 50; ++tries) {
    before = now;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    now = mallinfo2().uordblks;
  }
  REQUIRE(now == before);
  return static_cast<double>(now);
}

/// Mean distance between two motions' joint of that name in those frames.
double joint_apart_mm(const Motion& one, const Motion& other, const std::string& joint,
                      Eigen::Index first, Eigen::Index frames) {
  const MatrixD off = places_mm(one) - places_mm(other);
  return off.block(first, 3 * one.skeleton.find(joint), frames, 3).rowwise().norm().mean();
}

}  // namespace

TEST_CASE("live: every frame comes back once, in order, no later than the latency given") {
  on_every_device([](Device& device) {
    for (const double fps : {30.0, 60.0, 47.0, 20.0})
      for (const std::size_t look_ahead : {0U, 2U}) {
        CAPTURE(fps);
        CAPTURE(look_ahead);
        const LiveScene scene(fps, 40);
        const Model model = scene.model(device);
        LiveRegeneration live(model, scene.track, scene.placement(), look_ahead);
        CHECK(live.latency_frames() == static_cast<int>(look_ahead) + 3);
        std::size_t back = 0, latest = 0;
        for (std::size_t pushed = 1; pushed <= 40; ++pushed) {
          back += live.push(frame_of(scene.track, static_cast<Eigen::Index>(pushed) - 1)).size();
          // Of the frames that the track is at, in seconds.
          const double late_s = static_cast<double>(pushed - back) / fps;
          CHECK(late_s * 30 <= live.latency_frames() + 1e-9);
          latest = std::max(latest, pushed - back);
        }
        if (fps == 30) CHECK(latest == look_ahead + 3);  // and no sooner
        back += live.finish().size();
        CHECK(back == 40);
        CHECK(live.fps() == fps);
      }
  });
}

TEST_CASE(
    "live: what comes back is near the whole clip's answer, no further from truth and track") {
  on_every_device([](Device& device) {
    const LiveScene scene;
    const Model model = scene.model(device);
    LiveRegeneration live(model, scene.track, scene.placement());
    const Motion got = followed(live, scene.track);
    REQUIRE(got.frames() == 50);
    const Motion whole = regenerate_clip(model, scene.track, scene.placement(), {}).front();
    const double apart = apart_mm(got, whole), off = apart_mm(got, scene.clip),
                 whole_off = apart_mm(whole, scene.clip);
    CAPTURE(apart);
    CAPTURE(off);
    CAPTURE(whole_off);
    // A prior this uncertain leaves the whole clip's fit, too, some way off the truth.
    CHECK(apart < 15);
    CHECK(off < whole_off + 5);
    const auto off_track_px = [&](const Motion& motion) {
      return (project_motion(motion, live.camera()).x_px - scene.track.x_px).cwiseAbs().mean();
    };
    CHECK(off_track_px(got) < 1.2 * off_track_px(whole));
    for (int t = 1; t < 50; ++t)
      CHECK((got.channels.row(t) - got.channels.row(t - 1)).cwiseAbs().maxCoeff() < 60);
  });
}

TEST_CASE("live: a frame between two poses is between them") {
  Skeleton skeleton;
  skeleton.joints.push_back({"Hips", -1, {0, 0, 0}, {Channel::x_position}, {}});
  LiveOutput output(30, 75);
  for (int frame = 0; frame < 6; ++frame) output.expect(frame != 4);
  std::vector<double> got;
  for (const double at : {0.0, 10.0, 20.0})
    for (const LiveFrame& frame : output.add(skeleton, RowVectorD::Constant(1, at), true)) {
      CHECK(frame.seen == (got.size() != 4));
      got.push_back(frame.channels[0]);
    }
  REQUIRE(got.size() == 6);
  for (std::size_t frame = 0; frame < 6; ++frame)
    CHECK(got[frame] == doctest::Approx(4.0 * static_cast<double>(frame)));
}

TEST_CASE("live: a detector's keypoints as the whole clip has them, exchanged sides put right") {
  on_every_device([](Device& device) {
    LiveScene scene;
    const Model model = scene.model(device);
    scene.track = coco_keypoints_of(scene);
    ClipPlacement placement = scene.placement();
    const auto got = [&] {
      LiveRegeneration live(model, scene.track, placement);
      return followed(live, scene.track);
    };
    const Motion right = got();
    const Motion whole = regenerate_clip(model, scene.track, placement, {}).front();
    CHECK(apart_mm(right, whole) < 25);
    for (const std::string joint : {"shoulder", "elbow", "wrist", "hip", "knee", "ankle"}) {
      const int left = scene.track.find("left_" + joint),
                other = scene.track.find("right_" + joint);
      REQUIRE(left >= 0);
      for (MatrixD* values : {&scene.track.x_px, &scene.track.y_px})
        for (int t = 25; t < 28; ++t) std::swap((*values)(t, left), (*values)(t, other));
    }
    CHECK(apart_mm(got(), right) < 3);
  });
}

TEST_CASE("live, and the whole clip: keypoints are a detector's, whether that is given or not") {
  on_every_device([](Device& device) {
    LiveScene scene;
    const Model model = scene.model(device);
    scene.track = coco_keypoints_of(scene);
    ClipPlacement placement = scene.placement();
    placement.fit = TrackFitSettings{};            // several solutions: they would find out
    placement.fit->detector_noise_heights = 0.05;  // that it is better than this
    const auto answers = [&] {
      LiveRegeneration live(model, scene.track, placement);
      return std::vector{followed(live, scene.track),
                         regenerate_clip(model, scene.track, placement, {}).front()};
    };
    const std::vector<Motion> not_given = answers();
    placement.detected = true;
    const std::vector<Motion> given = answers();
    for (std::size_t i = 0; i < given.size(); ++i)
      CHECK(given[i].channels == not_given[i].channels);
  });
}

TEST_CASE("live: missing joints follow from the others and by the frames around") {
  on_every_device([](Device& device) {
    LiveScene scene;
    const Model model = scene.model(device);
    hide(scene.track, 20, 8, scene.track.find("LeftHand"));
    hide(scene.track, 35, 2);
    LiveRegeneration live(model, scene.track, scene.placement());
    const Motion got = followed(live, scene.track);
    const Motion whole = regenerate_clip(model, scene.track, scene.placement(), {}).front();
    CHECK(got.channels.allFinite());
    CHECK(apart_mm(got, scene.clip) < apart_mm(whole, scene.clip) + 5);
  });
}

TEST_CASE(
    "live: a joint that is missing for long is shown to the network where the solution has it") {
  on_every_device([](Device& device) {
    LiveScene scene;
    scene.view.azimuth_deg += 120;  // from there the hand is not where its mean is
    scene.camera = place_camera(scene.clip, scene.view);
    scene.track = project_motion(scene.clip, scene.camera);
    const Model model{hand_network(device, scene.modalities, -0.5F), scene.modalities, {}, {}};
    const auto got = [&] {
      LiveRegeneration live(model, scene.track, scene.placement());
      return followed(live, scene.track);
    };
    const int hand = scene.track.find("LeftHand"), first = 15, frames = 30;
    hide(scene.track, first, frames, hand);
    const Motion missing = got();
    const Track2d solution = project_motion(missing, scene.camera);
    const auto with_hand = [&](double aside_px) {
      for (int t = first; t < first + frames; ++t) {
        scene.track.x_px(t, hand) = solution.x_px(t, solution.find("LeftHand")) + aside_px;
        scene.track.y_px(t, hand) = solution.y_px(t, solution.find("LeftHand"));
        scene.track.confidence(t, hand) = 0.01;  // for the network, and next to nothing to the fit
      }
      return got();
    };
    // Ten frames later the network no longer looks back at what was seen.
    const auto hand_apart_mm = [&](const Motion& one, const Motion& other) {
      return joint_apart_mm(one, other, "LeftHand", first + 10, frames - 10);
    };
    CHECK(hand_apart_mm(with_hand(0), missing) < 5);
    CHECK(hand_apart_mm(with_hand(400), missing) > 100);
  });
}

TEST_CASE("live: before anybody is seen it is the mean pose; who comes back is found anew") {
  on_every_device([](Device& device) {
    LiveScene scene(30, 90);
    const Model model = scene.model(device);
    hide(scene.track, 0, 20);
    hide(scene.track, 40, 25);
    scene.track.x_px.bottomRows(25).array() += 500;  // elsewhere
    LiveRegeneration live(model, scene.track, scene.placement());
    std::vector<LiveFrame> frames;
    for (int t = 0; t < 90; ++t)
      for (LiveFrame& frame : live.push(frame_of(scene.track, t))) {
        frames.push_back(std::move(frame));
        CHECK(t + 1 - static_cast<int>(frames.size()) <= live.latency_frames());
      }
    for (LiveFrame& frame : live.finish()) frames.push_back(std::move(frame));
    REQUIRE(frames.size() == 90);
    for (int t = 0; t < 90; ++t)
      CHECK(frames[static_cast<std::size_t>(t)].seen == (t >= 65 || (t >= 20 && t < 40)));
    Motion end{live.skeleton(), 1.0 / 30, MatrixD(10, live.skeleton().channel_count())};
    for (int t = 0; t < 10; ++t)
      end.channels.row(t) = frames[static_cast<std::size_t>(80 + t)].channels;
    const Track2d shown = project_motion(end, live.camera());
    CHECK((shown.x_px - scene.track.x_px.bottomRows(10)).cwiseAbs().mean() < 5);
  });
}

TEST_CASE("live: which frames show nobody is known at every rate") {
  on_every_device([](Device& device) {
    for (const double fps : {60.0, 47.0, 20.0}) {
      CAPTURE(fps);
      LiveScene scene(fps, 60);
      const Model model = scene.model(device);
      hide(scene.track, 0, 12);
      hide(scene.track, 30, 10);
      LiveRegeneration live(model, scene.track, scene.placement());
      std::vector<LiveFrame> frames;
      const auto add = [&](std::vector<LiveFrame> more) {
        std::ranges::move(more, std::back_inserter(frames));
      };
      for (int t = 0; t < 60; ++t) add(live.push(frame_of(scene.track, t)));
      add(live.finish());
      REQUIRE(frames.size() == 60);
      for (int t = 0; t < 60; ++t) {
        CAPTURE(t);
        const bool seen = frames[static_cast<std::size_t>(t)].seen;
        const bool hidden = t < 12 || (t >= 30 && t < 40);
        // The pose between the mean one and the first of the person is neither's.
        if (t < 12 || t >= 15) CHECK(seen == !hidden);
      }
    }
  });
}

TEST_CASE("live: the mean pose stands on the ground") {
  on_every_device([](Device& device) {
    LiveScene scene;
    const Model model = scene.model(device);
    hide(scene.track, 0, 50);
    ClipPlacement placement = scene.placement();
    for (const bool known : {true, false}) {
      if (!known) placement.camera.reset();
      LiveRegeneration live(model, scene.track, placement);
      const Motion got = followed(live, scene.track);
      REQUIRE(got.frames() == 50);
      const MatrixD places = joint_positions(got);
      const double metre = file_units_per_metre(got.skeleton);
      for (int t = 0; t < 50; ++t) {
        const Eigen::Map<const MatrixD> joints(places.row(t).data(), got.skeleton.joint_count(), 3);
        CHECK(std::abs(joints.col(1).minCoeff()) < 1e-6 * metre);
        CHECK(joints(0, 1) > 0.5 * metre);  // the hips
      }
    }
  });
}

TEST_CASE("live: two tracks at once are as each by itself") {
  on_every_device([](Device& device) {
    const LiveScene one, other(47, 50);
    const Model model = one.model(device);
    const auto alone = [&](const LiveScene& scene) {
      LiveRegeneration live(model, scene.track, scene.placement());
      return followed(live, scene.track);
    };
    LiveRegeneration first(model, one.track, one.placement()),
        second(model, other.track, other.placement());
    std::vector<LiveFrame> of_first, of_second;
    for (int t = 0; t < 50; ++t) {
      for (LiveFrame& frame : first.push(frame_of(one.track, t)))
        of_first.push_back(std::move(frame));
      for (LiveFrame& frame : second.push(frame_of(other.track, t)))
        of_second.push_back(std::move(frame));
    }
    const Motion want = alone(one), want_other = alone(other);
    REQUIRE(of_first.size() > 40);
    for (std::size_t t = 0; t < of_first.size(); ++t)
      CHECK(of_first[t].channels == want.channels.row(static_cast<Eigen::Index>(t)));
    for (std::size_t t = 0; t < of_second.size(); ++t)
      CHECK(of_second[t].channels == want_other.channels.row(static_cast<Eigen::Index>(t)));
  });
}

TEST_CASE("live: memory does not grow with the frames") {
  on_every_device([](Device& device) {
    LiveScene scene;
    const Model model = scene.model(device);
    LiveRegeneration live(model, scene.track, scene.placement());
    const auto follow = [&](int frames) {
      for (int t = 0; t < frames; ++t) (void)live.push(frame_of(scene.track, t % 50));
      return memory_at_rest();
    };
    // From then on as much of the past is kept; it is looked at every 15 frames.
    const auto before = follow(600), after = follow(390);
    // What a frame takes, 14 joints and their features, would be 390 KB.
    CHECK(after - before < 50'000);
  });
}

TEST_CASE("live: with an unknown camera the first frame stands at the origin") {
  on_every_device([](Device& device) {
    const LiveScene scene;
    const Model model = scene.model(device);
    ClipPlacement placement = scene.placement();
    placement.camera.reset();
    LiveRegeneration live(model, scene.track, placement);
    const Motion got = followed(live, scene.track);
    const MatrixD root = joint_positions(got).leftCols(3);
    const double metre = file_units_per_metre(got.skeleton);
    CHECK(std::hypot(root(0, 0), root(0, 2)) < 0.1 * metre);
    CHECK(root(0, 1) > 0.5 * metre);
    CHECK(root(0, 1) < 1.5 * metre);
    const Track2d shown = project_motion(got, live.camera());
    CHECK((shown.x_px - scene.track.x_px).cwiseAbs().mean() < 5);
  });
}

TEST_CASE("live: what cannot be followed is reported") {
  on_every_device([](Device& device) {
    const LiveScene scene;
    const Model model = scene.model(device);
    CHECK_THROWS_AS(LiveRegeneration(model, scene.track, scene.placement(), kLookAhead + 1),
                    ConfigError);
    ClipPlacement placement = scene.placement();
    placement.fit.reset();
    CHECK_THROWS_AS(LiveRegeneration(model, scene.track, placement), ConfigError);
    placement = scene.placement();
    placement.skeleton->joints[3].name = "Other";
    CHECK_THROWS_AS(LiveRegeneration(model, scene.track, placement), ConfigError);
    LiveRegeneration live(model, scene.track, scene.placement());
    CHECK_THROWS_AS(live.push(TrackFrame::unseen(3)), ShapeError);
    CHECK(live.finish().empty());
  });
}
