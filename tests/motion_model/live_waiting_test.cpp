// A track frame by frame: before anybody is seen, and where a stop is asked for.

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

#include "base/interruption.hpp"
#include "camera/projected_keypoints.hpp"
#include "device/every_device.hpp"
#include "fitting/usual_body.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/motion/humanoid.hpp"
#include "motion/body_size.hpp"
#include "motion_model/live_scene.hpp"

namespace live_waiting_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("live: a frame that shows nobody costs no answer until a person was found") {
  on_every_device([](Device& device) {
    LiveScene scene;
    const Model model = scene.model(device);
    hide(scene.track, 0, 20);
    LiveRegeneration live(model, scene.track, scene.placement());
    const auto launches_for = [&](int frame) {
      const std::uint64_t before = device.launch_count();
      (void)live.push(frame_of(scene.track, frame));
      return device.launch_count() - before;
    };
    for (int t = 0; t < 20; ++t) CHECK(launches_for(t) == 0);
    CHECK(launches_for(20) > 0);
    hide(scene.track, 21, 1);
    CHECK(launches_for(21) > 0);  // the person is only hidden
  });
}

TEST_CASE("live: what comes before anybody is known without the track's joints") {
  on_every_device([](Device& device) {
    LiveScene scene;
    const Model model = scene.model(device);
    hide(scene.track, 0, 50);
    ClipPlacement placement = scene.placement();
    for (const bool known : {true, false}) {
      CAPTURE(known);
      if (!known) placement.camera.reset();
      if (!known) placement.skeleton.reset();
      const Motion before = LiveRegeneration::before_anybody(model, placement);
      REQUIRE(before.frames() == 1);
      LiveRegeneration live(model, scene.track, placement);
      const Motion got = followed(live, scene.track);
      const MatrixD places = joint_positions(got), expected = joint_positions(before);
      for (int t = 0; t < 50; ++t)
        CHECK((places.row(t) - expected).norm() < 1e-6 * file_units_per_metre(before.skeleton));
      for (std::size_t joint = 0; joint < got.skeleton.joints.size(); ++joint)
        CHECK(before.skeleton.joints[joint].offset == got.skeleton.joints[joint].offset);
    }
    placement.fit.reset();
    CHECK_THROWS_AS(LiveRegeneration::before_anybody(model, placement), ConfigError);
    placement = scene.placement();
    CHECK_THROWS_AS(LiveRegeneration::before_anybody(model, placement, kLookAhead + 1),
                    ConfigError);
    placement.skeleton->joints[3].name = "Other";
    CHECK_THROWS_AS(LiveRegeneration::before_anybody(model, placement), ConfigError);
  });
}

TEST_CASE("live: before a detector shows anybody the body is the one that its fit begins with") {
  Motion motion{canonical_humanoid(), 1.0 / 30, {}};
  motion.channels = MatrixD::Zero(24, motion.skeleton.channel_count());
  motion.channels.col(1).setConstant(95);
  for (int t = 0; t < motion.frames(); ++t)
    for (Eigen::Index c = 3; c < motion.channels.cols(); ++c)
      motion.channels(t, c) = 8 * std::sin(0.3 * t + static_cast<double>(c));
  const Modalities modalities = modalities_of({motion}, {});
  Track2d track = project_keypoints(motion, humanoid_roles(), joint_set("BODY_25").keypoints,
                                    place_camera(motion, {}));
  hide(track, 0, track.frames());
  on_every_device([&](Device& device) {
    const Model model{quiet_network(device, modalities), modalities, {}, {}};
    const Motion before = LiveRegeneration::before_anybody(model, {});
    LiveRegeneration live(model, track, {});
    const Motion got = followed(live, track);
    const Skeleton usual = usual_body(canonical_humanoid());
    bool differs = false;
    for (std::size_t joint = 0; joint < usual.joints.size(); ++joint) {
      const Eigen::Vector3d& offset = before.skeleton.joints[joint].offset;
      CHECK(offset == usual.joints[joint].offset);
      CHECK(offset == got.skeleton.joints[joint].offset);
      differs = differs || offset != motion.skeleton.joints[joint].offset;
    }
    CHECK(differs);
    const MatrixD places = joint_positions(got), expected = joint_positions(before);
    for (int t = 0; t < got.frames(); ++t)
      CHECK((places.row(t) - expected).norm() < 1e-6 * file_units_per_metre(before.skeleton));
  });
}

TEST_CASE("live: who defers a stop gets all frames, whatever the past is looked at for") {
  on_every_device([](Device& device) {
    const LiveScene scene;
    const Model model = scene.model(device);
    ClipPlacement placement = scene.placement();
    placement.camera.reset();  // it is looked for in the past, and so is the body
    placement.skeleton.reset();
    LiveRegeneration undisturbed(model, scene.track, placement);
    const Motion wanted = followed(undisturbed, scene.track);
    Motion got;
    request_interruption();
    {
      const InterruptionDeferred until_the_end;
      CHECK_NOTHROW([&] {
        LiveRegeneration live(model, scene.track, placement);
        got = followed(live, scene.track);
      }());
    }
    clear_interruption();
    REQUIRE(got.frames() == wanted.frames());
    CHECK(got.channels == wanted.channels);
  });
}

}  // namespace live_waiting_test
