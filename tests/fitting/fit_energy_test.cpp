// The energy of a fit, by which readings of a track are compared.

#include <doctest/doctest.h>

#include "camera/track_columns.hpp"
#include "camera/track_noise.hpp"
#include "features/clip_modalities.hpp"
#include "mcdbn/fitting/track_fit.hpp"
#include "mcdbn/synthesis/synthesize.hpp"

namespace fit_energy_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE(
    "fit energy: a track whose legs are exchanged is less likely, in any window of the clip") {
  const Motion truth = synthesize({.seconds = 14});  // 420 frames: two windows
  const Modalities modalities = modalities_of({truth}, {});
  KnownOfClip known{place_camera(truth, {}), truth.skeleton};
  known.detected = true;
  const Track2d track = project_motion(truth, *known.camera);
  const MatrixF mean = modalities.encode_pose(truth, known.camera->camera_from_world);
  TrackFitSettings rough;
  rough.most_solutions = 0;
  for (const auto& settings : {rough, TrackFitSettings{}}) {
    const auto energy = [&](const Track2d& seen) {
      return fit_to_track(mean, modalities, seen, known, settings).energy;
    };
    const double right = energy(track);
    CHECK(right > 0);
    CHECK(energy(track) == right);
    for (const int first : {20, 380}) {
      CAPTURE(first);
      Track2d exchanged = track;
      for (int t = first; t < first + 20; ++t)
        for (const char* joint : {"UpLeg", "Leg", "Foot"})
          exchange_columns(exchanged, t, track.find(std::string("Left") + joint),
                           track.find(std::string("Right") + joint));
      CHECK(energy(exchanged) > right + 10);
    }
  }
  CHECK(fit_to_track(mean, modalities, track, known, std::nullopt).energy == 0);
}

TEST_CASE("fit energy: a detector's track is left sooner, near where steps end") {
  const Motion truth = synthesize({.seconds = 4});
  const Modalities modalities = modalities_of({truth}, {});
  KnownOfClip known{place_camera(truth, {}), {}};
  const Track2d exact = project_motion(truth, *known.camera);
  const MatrixF mean = MatrixF::Zero(exact.frames(), modalities.pose_scale.output_dimension());
  int sooner = 0;
  for (const double noise_px : {3.0, 6.0, 9.0, 12.0}) {
    Track2d track = exact;
    add_pixel_noise(track, noise_px, 1);
    const auto energy = [&](bool detected) {
      known.detected = detected;
      return fit_to_track(mean, modalities, track, known, TrackFitSettings{}).energy;
    };
    const double left = energy(true), ended = energy(false);
    CHECK(left >= ended);
    CHECK(left < 1.02 * ended);
    sooner += left > ended ? 1 : 0;
  }
  CHECK(sooner > 0);
}

}  // namespace fit_energy_test
