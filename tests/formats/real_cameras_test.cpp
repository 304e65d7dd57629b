// Calibrations of other tools, as they wrote them.

#include <doctest/doctest.h>

#include "formats/camera_facts.hpp"
#include "shared_data.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("camera formats: real calibrations") {
  struct Case {
    const char *file, *format, *first;
    int cameras;
    double farthest_m;
  };
  for (const Case& c : {
           Case{"formats/calibration/pose2sim_toml/Calib_qualisys.toml", "pose2sim", "cam_01", 4,
                6},
           Case{"formats/calibration/pose2sim_toml/Pose2Sim_cameras.toml", "pose2sim", "cam_01", 4,
                6},
           Case{"formats/calibration/pose2sim_toml/Sports2D_Calib_demo.toml", "pose2sim", "demo", 1,
                12},
           Case{"formats/calibration/caliscope_toml/camera_array.toml", "caliscope", "0", 4, 4},
           Case{"formats/calibration/caliscope_toml/config.toml", "caliscope", "cam_0", 4, 4},
           Case{"formats/calibration/easymocap_yml/intri.yml", "easymocap", "2", 6, 9},
           Case{"formats/calibration/easymocap_yml/extri.yml", "easymocap", "2", 6, 9},
           Case{"formats/calibration/qualisys_qca/Calib.qca.txt", "qualisys", "cam01", 4, 6},
           Case{"formats/calibration/voxelpose_json/calibration_shelf.json", "voxelpose", "0", 5,
                9},
           Case{"formats/calibration/voxelpose_json/calibration_campus.json", "voxelpose", "0", 3,
                15},
           Case{"mhad/camera-calibration.json", "mhad", "K1.C1", 14, 6},
       }) {
    if (!have_shared_data(c.file, "camera formats")) continue;
    const auto path = shared_data() / c.file;
    CAPTURE(c.file);
    CHECK(format_of(path) == c.format);
    const CameraRig rig = read_cameras(path);
    CHECK(rig.cameras.size() == static_cast<std::size_t>(c.cameras));
    CHECK(rig.cameras.front().name == c.first);
    for (const NamedCamera& named : rig.cameras) {
      CAPTURE(named.name);
      const Eigen::Vector3d centre = centre_m(named.camera), up = up_of(named.camera);
      CHECK(centre.norm() < c.farthest_m);
      CHECK(centre.y() > -0.5);
      // Every one of them stands upright or rolls a little: up in the world is up in the image.
      CHECK(up.y() < -0.5);
    }
  }
}

TEST_CASE("camera formats: Qualisys' file and Pose2Sim's of one session are the same cameras") {
  const std::string folder = "formats/calibration/";
  if (!have_shared_data(folder, "camera formats")) return;
  const CameraRig a = read_cameras(shared_data() / folder / "qualisys_qca/Calib.qca.txt"),
                  b = read_cameras(shared_data() / folder / "pose2sim_toml/Calib_qualisys.toml");
  REQUIRE(a.cameras.size() == b.cameras.size());
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    const Camera &one = a.cameras[i].camera, &other = b.cameras[i].camera;
    CHECK((one.camera_from_world - other.camera_from_world).cwiseAbs().maxCoeff() < 1e-6);
    CHECK((centre_m(one) - centre_m(other)).norm() < 1e-5);
    CHECK(one.fx_px == doctest::Approx(other.fx_px));
    CHECK(one.cy_px == doctest::Approx(other.cy_px));
    CHECK(one.width_px == other.width_px);
    CHECK(one.height_px == other.height_px);
    for (int k = 0; k < 4; ++k)
      CHECK(one.distortion[static_cast<std::size_t>(k)] ==
            doctest::Approx(other.distortion[static_cast<std::size_t>(k)]));
  }
}
