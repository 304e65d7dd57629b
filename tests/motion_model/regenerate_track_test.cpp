// From clips to tracks: every option on its way to its use.

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/clip_regeneration.hpp"
#include "motion/resample.hpp"
#include "motion_model/clip_scene.hpp"

namespace regenerate_track_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct Scene {
  Motion training = swinging(small_body(), 60);
  CameraPlacement view{35, 12, std::nullopt, 45, 1281, 720};
  Modalities modalities = modalities_of({training}, view);
  Motion clip = swinging(small_body(), 100, 60.0);
  Camera other = place_camera(clip, {-50, 3, std::nullopt, 30, 640, 480});

  Model model(Device& device) const {
    return {random_network(device, modalities), modalities, {}, {}};
  }
};

/// The features that training learns from, the network, and its answer in pixels, one by one.
std::vector<Track2d> step_by_step(const Model& model, const Motion& clip, const Camera& camera,
                                  const RegenerationOptions& options) {
  const Modalities& m = model.modalities;
  const Motion at_rate = resample(clip, m.fps);
  const MatrixF pose =
      m.pose_scale.apply(m.pose_features.encode(at_rate, camera.camera_from_world));
  std::vector<Track2d> tracks;
  for (const MatrixF& answer : regenerate(model.network, {{}, {pose}}, 0, options))
    tracks.push_back(m.track_features.decode(m.track_scale.invert(answer), m.fps, camera.width_px,
                                             camera.height_px));
  return tracks;
}

void check_same(const std::vector<Track2d>& got, const std::vector<Track2d>& want) {
  REQUIRE(got.size() == want.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    CHECK(got[i].joint_names == want[i].joint_names);
    CHECK(got[i].x_px == want[i].x_px);
    CHECK(got[i].y_px == want[i].y_px);
    CHECK(got[i].fps == want[i].fps);
    CHECK(got[i].width_px == want[i].width_px);
    CHECK(got[i].height_px == want[i].height_px);
  }
}

}  // namespace

TEST_CASE("regenerate_track: the network's answer to what training sees, in pixels of the camera") {
  const Scene scene;
  RegenerationOptions drawn;
  drawn.samples = 2;
  drawn.temperature = 0.8;
  drawn.sampling = {.gibbs_steps = 2, .mrbm_gibbs_steps = 3, .steady = true, .scale = 0.9};
  drawn.seed = 41;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    for (const RegenerationOptions& options : {RegenerationOptions{}, drawn}) {
      const auto own = regenerate_track(model, scene.clip, options);
      const auto seen = regenerate_track(model, scene.clip, options, scene.other);
      check_same(own,
                 step_by_step(model, scene.clip, place_camera(scene.clip, scene.view), options));
      check_same(seen, step_by_step(model, scene.clip, scene.other, options));
      CHECK(own[0].frames() == 50);  // 100 at twice the model's rate
      CHECK(own[0].fps == 30.0);
      CHECK(own[0].joint_names.front() == "Hips");
      CHECK(own[0].width_px == 1281);
      CHECK(seen[0].height_px == 480);
      CHECK((own[0].x_px - seen[0].x_px).cwiseAbs().maxCoeff() > 1);
    }
    const auto two = regenerate_track(model, scene.clip, drawn);
    CHECK((two[0].x_px - two[1].x_px).cwiseAbs().maxCoeff() > 1e-3);
    Motion lost = scene.clip;
    for (Joint& joint : lost.skeleton.joints) joint.name += "?";
    CHECK_THROWS_AS(regenerate_track(model, lost, {}), InputError);
  });
}

}  // namespace regenerate_track_test
