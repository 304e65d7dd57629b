// Calibrations of other tools, on small files that are written here, and on real ones.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <opencv2/calib3d.hpp>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "camera/odd_camera.hpp"
#include "formats/camera_facts.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/camera_file.hpp"

using namespace mcdbn;
using namespace test;

namespace {

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

/// One section as Anipose writes it, of a camera that looks along a z-up world's y from 3 m away
/// and 1.2 m above the floor.
std::string section(const std::string& name, double unit, const std::string& more,
                    const std::string& distortions = "0.1, -0.02, 0.003, 0.004") {
  return fmt::format(
      "[{0}]\nname = \"{0}\"\nsize = [ 1280.0, 720]\n"
      "matrix = [ [ 1000.5, 0, 630.25,], [ 0.0, 1001.5, 350.75,],\n  [ 0, 0.0, 1.0,],]\n"
      "distortions = [ {1},]\nrotation = [ 1.5707963267948966, 0.0, 0,]\n"
      "translation = [ 0.0, {2}, {3},]\n{4}\n",
      name, distortions, 1.2 * unit, 3 * unit, more);
}

void check_as_section(const Camera& camera, double unit_m) {
  CHECK(camera.width_px == 1280);
  CHECK(camera.height_px == 720);
  CHECK(camera.fx_px == 1000.5);
  CHECK(camera.fy_px == 1001.5);
  CHECK(camera.cx_px == 630.25);
  CHECK(camera.cy_px == 350.75);
  CHECK(camera.unit_m == unit_m);
  CHECK((up_of(camera) - Eigen::Vector3d(0, -1, 0)).norm() < 1e-9);
  CHECK((centre_m(camera) - Eigen::Vector3d(0, 1.2, 3)).norm() < 1e-9);
}

}  // namespace

TEST_CASE("camera formats: Pose2Sim's world is z-up and in metres, its sizes are floats") {
  const ScratchFolder folder;
  const auto file = folder.write("Calib.toml", section("cam_01", 1, "fisheye = false") +
                                                   section("cam_02", 1, "fisheye = false") +
                                                   "[metadata]\nadjusted = false\nerror = 0.0\n");
  CHECK(format_of(file) == "pose2sim");
  const CameraRig rig = read_cameras(file);
  REQUIRE(rig.cameras.size() == 2);
  CHECK(rig.cameras[1].name == "cam_02");
  check_as_section(rig.cameras[0].camera, 1.0);
  CHECK(rig.cameras[0].camera.distortion == std::vector<double>{0.1, -0.02, 0.003, 0.004});
}

TEST_CASE("camera formats: of several cameras one is chosen by name") {
  const ScratchFolder folder;
  const auto file =
      folder.write("Calib.toml", section("cam_01", 1, "fisheye = false") +
                                     section("cam_02", 1, "fisheye = false", "0.5, 0, 0, 0"));
  CHECK_THROWS_WITH_AS(read_camera(file), doctest::Contains("(there are: cam_01, cam_02)"),
                       InputError);
  std::vector<std::string> assumed;
  const Camera camera = read_camera(file.string() + ":cam_02", &assumed);
  CHECK(camera.distortion.front() == 0.5);
  REQUIRE(assumed.size() == 1);
  CHECK(assumed[0].ends_with("cam_02: its world is z-up and in metres (pose2sim)"));
  CHECK_THROWS_WITH_AS(read_camera(file.string() + ":cam_9"),
                       doctest::Contains("no camera cam_9; there are: cam_01, cam_02"), InputError);
  // A file whose own name has a colon, and a single camera without a name.
  const auto odd = folder.write("a:b.toml", section("one", 1, "fisheye = false"));
  check_as_section(read_camera(odd), 1.0);
  check_as_section(read_camera(odd.string() + ":one"), 1.0);
}

TEST_CASE("camera formats: nothing is assumed of a file of our own that gives its unit") {
  const ScratchFolder folder;
  Camera camera = test::odd_camera();
  for (const bool has_unit : {true, false}) {
    CAPTURE(has_unit);
    camera.unit_m.reset();
    if (has_unit) camera.unit_m = 0.01;
    write_camera(folder / "own.yml", camera);
    std::vector<std::string> assumed, stated;
    read_camera(folder / "own.yml", &assumed, &stated);
    CHECK(assumed.size() == (has_unit ? 0 : 1));
    CHECK(stated.size() == (has_unit ? 1 : 0));
    const std::string& line = has_unit ? stated.at(0) : assumed.at(0);
    CHECK(line.starts_with((folder / "own.yml").string() + ": its world is y-up"));
    CHECK(line.ends_with(" (opencv)"));
  }
}

TEST_CASE("camera formats: Anipose's units follow from how far the cameras stand") {
  const ScratchFolder folder;
  const auto file = folder.write(
      "calibration.toml", section("cam_0", 1000, "", "0.1,\n 0, 0, 0, 0.2") + "[metadata]\n");
  CHECK(format_of(file) == "anipose");
  check_as_section(read_camera(file), 0.001);
  check_as_section(read_camera(folder.write("m.toml", section("cam_0", 1, "", "0, 0, 0, 0, 0"))),
                   1.0);
  // FreeMoCap's: the world is the first camera's, y down.
  std::string text = section("cam_0", 1000, "fisheye = false", "0, 0, 0, 0, 0");
  text.replace(text.find("1.5707963267948966"), 18, "0");
  text.replace(text.find("0.0, 1200, 3000"), 15, "0, 0, 0");
  const auto own = folder.write("own.toml", text + section("cam_1", 1000, "", "0, 0, 0, 0, 0"));
  const CameraRig rig = read_cameras(own);
  REQUIRE(rig.cameras.size() == 2);
  CHECK(largest(rig.cameras[0].camera.camera_from_world.col(1) + Eigen::Vector3d::UnitY()) < 1e-12);
  REQUIRE(rig.assumed.size() == 2);
  CHECK(rig.assumed[0].find("image of cam_0") != std::string::npos);
  CHECK(rig.assumed[1].find("millimetres") != std::string::npos);
}

TEST_CASE("camera formats: caliscope's rotations are matrices, its cameras lie deeper") {
  const ScratchFolder folder;
  std::string text = section("cameras.3", 1, "");
  const std::string vector = "[ 1.5707963267948966, 0.0, 0,]";
  text.replace(text.find(vector), vector.size(),
               "[[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0]]");
  text.replace(text.find("name = \"cameras.3\""), 18, "cam_id = 3");
  const auto file = folder.write("camera_array.toml", text);
  CHECK(format_of(file) == "caliscope");
  check_as_section(read_camera(file.string() + ":3"), 1.0);
}

TEST_CASE("camera formats: EasyMocap's two files are found from either") {
  const ScratchFolder folder;
  const auto matrix = [](const std::string& name, int rows, const std::string& data) {
    return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: 3\n   dt: d\n   data: [ {} ]\n",
                       name, rows, data);
  };
  const auto intri =
      folder.write("intri.yml", "%YAML:1.0\n---\nnames:\n   - \"1\"\n   - \"b\"\n" +
                                    matrix("K_1", 3, "900., 0., 960., 0., 901., 540., 0., 0., 1.") +
                                    "dist_1: [ 0.1, 0., 0., 0., 0. ]\n" +
                                    matrix("K_b", 3, "800., 0., 960., 0., 801., 540., 0., 0., 1."));
  CHECK_THROWS_WITH_AS(read_cameras(intri), doctest::Contains("put extri.yml beside it"),
                       InputError);
  const auto extri =
      folder.write("extri.yml", "%YAML:1.0\n---\nnames:\n   - \"1\"\n" +
                                    matrix("R_1", 1, "1.5707963267948966, 0., 0.") +
                                    matrix("Rot_1", 3, "1., 0., 0., 0., 0., -1., 0., 1., 0.") +
                                    matrix("T_1", 1, "0., 1.2, 3."));
  for (const auto& file : {intri, extri}) {
    CHECK(format_of(file) == "easymocap");
    const CameraRig rig = read_cameras(file);
    REQUIRE(rig.cameras.size() == 1);  // b has no pose
    const Camera& camera = rig.cameras[0].camera;
    CHECK(rig.cameras[0].name == "1");
    CHECK(camera.fy_px == 901);
    CHECK(camera.width_px == 1920);
    CHECK(camera.size_is_guess);
    CHECK(camera.height_px == 1080);
    CHECK(camera.distortion.size() == 5);
    CHECK((centre_m(camera) - Eigen::Vector3d(0, 1.2, 3)).norm() < 1e-9);
    CHECK((up_of(camera) - Eigen::Vector3d(0, -1, 0)).norm() < 1e-9);
    REQUIRE(rig.assumed.size() == 2);
    CHECK(rig.assumed[1].find("no image size") != std::string::npos);
  }
  const CameraRig sized =
      read_cameras(folder.write("intri.yml", read_text_file(intri) + "W_1: 1280\nH_1: 720\n"));
  CHECK(sized.cameras[0].camera.width_px == 1280);
  CHECK(sized.cameras[0].camera.height_px == 720);
  CHECK_FALSE(sized.cameras[0].camera.size_is_guess);
  CHECK(sized.assumed.size() == 1);
}

TEST_CASE("camera formats: Qualisys' pixels are 64ths, its camera looks backwards with y up") {
  const ScratchFolder folder;
  const std::string text =
      "<?xml version='1.0'?>\n<calibration>\n <cameras>\n  <camera serial=\"c7\" "
      "viewrotation=\"90\">\n"
      "   <fov_video left=\"0\" right=\"1279\" top=\"0\" bottom=\"719\"/>\n"
      "   <transform r11=\"1\" r12=\"0\" r13=\"0\" r21=\"0\" r22=\"0\" r23=\"1\" r31=\"0\" "
      "r32=\"-1\" r33=\"0\" x=\"0\" y=\"-3000\" z=\"1200\"/>\n"
      "   <intrinsic focalLengthU=\"64032\" focalLengthV=\"64096\" centerPointU=\"40336\" "
      "centerPointV=\"22448\" radialDistortion1=\"6.4\" radialDistortion2=\"-0.64\" "
      "radialDistortion3=\"0\" tangentalDistortion1=\"0.064\" tangentalDistortion2=\"0.128\"/>\n"
      "  </camera>\n </cameras>\n</calibration>\n";
  const auto file = folder.write("a.qca.txt", text);
  CHECK(format_of(file) == "qualisys");
  const CameraRig rig = read_cameras(file);
  REQUIRE(rig.cameras.size() == 1);
  CHECK(rig.cameras[0].name == "c7");
  CHECK(rig.assumed.size() == 2);
  check_as_section(rig.cameras[0].camera, 0.001);
  CHECK(rig.cameras[0].camera.distortion[3] == doctest::Approx(0.002));
  // A part of the sensor: the principal point still counts from the sensor's corner.
  std::string part = text;
  const std::string whole_view = "left=\"0\" right=\"1279\" top=\"0\" bottom=\"719\"";
  part.replace(part.find(whole_view), whole_view.size(),
               "left=\"320\" right=\"1599\" top=\"180\" bottom=\"899\"");
  part.replace(part.find("40336"), 5, std::to_string(40336 + 64 * 320));
  part.replace(part.find("22448"), 5, std::to_string(22448 + 64 * 180));
  check_as_section(read_camera(folder.write("part.qca.txt", part)), 0.001);
  std::string broken = text;
  broken.replace(broken.find("r33=\"0\""), 7, "r33=\"1\"");
  CHECK_THROWS_WITH_AS(read_cameras(folder.write("b.txt", broken)),
                       doctest::Contains("b.txt:4: c7: transform is not a rotation"), InputError);
  broken.replace(broken.find("x=\"0\""), 5, "x=\"u\"");
  CHECK_THROWS_AS(read_cameras(folder.write("b.txt", broken)), InputError);
  CHECK_THROWS_WITH_AS(read_cameras(folder.write("b.txt", text.substr(0, text.find("</camera>")))),
                       doctest::Contains("not XML"), InputError);
}

TEST_CASE("camera formats: VoxelPose's T is where the camera is, in millimetres") {
  const ScratchFolder folder;
  const std::string text =
      R"({"0": {"R": [[1, 0, 0], [0, 0, -1], [0, 1, 0]], "T": [[0], [-3000], [1200]],
          "fx": 1000.5, "fy": 1001.5, "cx": 640, "cy": 360, "k": [[0.1], [0], [0.3]],
          "p": [[0], [0.2]]}})";
  const auto file = folder.write("c.json", text);
  CHECK(format_of(file) == "voxelpose");
  const Camera camera = read_camera(file);
  CHECK(camera.width_px == 1280);
  CHECK(camera.distortion == std::vector<double>{0.1, 0, 0, 0.2, 0.3});
  CHECK((centre_m(camera) - Eigen::Vector3d(0, 1.2, 3)).norm() < 1e-9);
  CHECK((up_of(camera) - Eigen::Vector3d(0, -1, 0)).norm() < 1e-9);
  std::string broken = text;
  broken.replace(broken.find("1000.5"), 6, "\"far\"");
  CHECK_THROWS_WITH_AS(read_camera(folder.write("d.json", broken)),
                       doctest::Contains("d.json: 0.fx:"), InputError);
}

TEST_CASE("camera formats: MHAD's cameras stand in clusters") {
  const ScratchFolder folder;
  const std::string text =
      R"({"clusters": {"L1": {"R_world_to_cluster": [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
          "t_mm": [0, 1200, 3000], "cameras": {"C1": {"K": [[500, 0, 320], [0, 501, 240],
          [0, 0, 1]], "dist_k1k2p1p2": [0.1, 0, 0, 0], "rel_t_mm": [-100, 0, 0],
          "rel_rotvec_rad": [0, 0, 3.141592653589793]}}}}})";
  const auto file = folder.write("c.json", text);
  CHECK(format_of(file) == "mhad");
  const Camera camera = read_camera(file.string() + ":L1.C1");
  CHECK(camera.width_px == 640);
  CHECK(camera.fy_px == 501);
  CHECK((centre_m(camera) - Eigen::Vector3d(-0.1, 1.2, 3)).norm() < 1e-9);
  CHECK((up_of(camera) - Eigen::Vector3d(0, 1, 0)).norm() < 1e-9);  // it hangs upside down
  std::string broken = text;
  broken.replace(broken.find("t_mm\": [0,"), 10, "t_mm\": [");
  CHECK_THROWS_WITH_AS(read_camera(folder.write("d.json", broken)),
                       doctest::Contains("d.json: clusters.L1.t_mm: has 2 numbers"), InputError);
}

TEST_CASE("camera formats: fisheye lenses, with four distortions or none") {
  const ScratchFolder folder;
  // Pose2Sim's, and Anipose's in millimetres.
  for (const double unit : {1.0, 1000.0}) {
    const Camera camera =
        read_camera(folder.write("fish.toml", section("cam_01", unit, "fisheye = true")));
    CHECK(camera.fisheye);
    CHECK(camera.distortion == std::vector<double>{0.1, -0.02, 0.003, 0.004});
    check_as_section(camera, 1 / unit);
    std::string text = section("cam_01", unit, "fisheye = true", "");
    text.replace(text.find("[ ,]"), 4, "[]");
    const Camera plain = read_camera(folder.write("fish.toml", text));
    CHECK(plain.fisheye);
    CHECK(plain.distortion.empty());
  }
  CHECK_THROWS_WITH_AS(
      read_cameras(folder.write("fish.toml", section("a", 1, "fisheye = true", "0, 0, 0, 0, 0"))),
      doctest::Contains(":6: a: distortions has 5 numbers; a fisheye has 4"), InputError);
  CHECK_FALSE(
      read_camera(folder.write("fish.toml", section("cam_01", 1, "fisheye = false"))).fisheye);
  for (const char* name : {"fish.yml", "fish.xml", "fish.json"}) {
    CAPTURE(name);
    Camera camera = test::odd_camera();
    camera.distortion.resize(4);
    camera.fisheye = true;
    write_camera(folder / name, camera);
    const Camera again = read_camera(folder / name);
    CHECK(again.fisheye);
    CHECK(again.distortion == camera.distortion);
    camera.fisheye = false;
    write_camera(folder / name, camera);
    CHECK_FALSE(read_camera(folder / name).fisheye);
  }
}

TEST_CASE("camera formats: what is wrong with a TOML is named with file, line and camera") {
  const ScratchFolder folder;
  const std::string good = section("cam_01", 1, "fisheye = false");
  struct Case {
    const char *from, *to, *message;
  };
  for (const Case& c :
       {Case{"size = [ 1280.0, 720]", "size = [ 1280.5, 720]", ":3: cam_01: size is not a whole"},
        Case{"size = [ 1280.0, 720]", "size = [ 1280 ]", ":3: cam_01: size has 1 numbers"},
        Case{"1000.5", "-1000.5", ":4: cam_01: matrix has no focal length"},
        Case{"1000.5", "\"f\"", ":4: cam_01: matrix holds something that is not a number"},
        Case{"1000.5", "nan", ":4: cam_01: matrix holds a number that is not finite"},
        Case{"0.1, -0.02, 0.003", "0.1, -0.02, inf", ":6: cam_01: distortions"},
        Case{"rotation = [ 1.57", "rotation = [ 1, 1.57", ":7: cam_01: rotation is not 3x3"},
        Case{"rotation", "turn", ":1: cam_01: rotation is missing"},
        Case{"3,]", "nan,]", ":8: cam_01: translation holds"},
        Case{"1280.0, 720]", "1280.0, ", "bad.toml:"}}) {
    CAPTURE(c.to);
    std::string text = good;
    REQUIRE(text.find(c.from) != std::string::npos);
    text.replace(text.find(c.from), std::string(c.from).size(), c.to);
    CHECK_THROWS_WITH_AS(read_cameras(folder.write("bad.toml", text)), doctest::Contains(c.message),
                         InputError);
  }
}

TEST_CASE("camera formats: what only nests, or is larger than any calibration, is refused unread") {
  const ScratchFolder folder;
  const auto many = [](const std::string& text, int times) {
    std::string result;
    for (int i = 0; i < times; ++i) result += text;
    return result;
  };
  for (const std::string& text :
       {"%YAML:1.0\n---\ncamera_matrix: " + many("[", 100'000),
        "%YAML:1.0\n---\ncamera_matrix:\n" + many("- ", 100'000),
        "{\"camera_matrix\": " + many("[", 100'000), "<opencv_storage>" + many("<a>", 100'000),
        "[cam]\nmatrix = " + many("[", 100'000)}) {
    CAPTURE(text.substr(0, 40));
    CHECK_THROWS_WITH_AS(read_cameras(folder.write("deep.yml", text)),
                         doctest::Contains("nested deeper"), InputError);
  }
  // Found by fuzzing: these ended the program.
  using namespace std::string_literals;
  for (const std::string& text :
       {"<?xml version=\0\0\0\0\"1.0\"?>\n<opencv_storage><a>3</a></opencv_storage>\n"s,
        "<?xml version=\"1.0\"?>\n<camera_matrix a=\0\0\x04\x1e\"5\"></camera_matrix>\n"s})
    CHECK_THROWS_WITH_AS(read_cameras(folder.write("bytes.xml", text)),
                         doctest::Contains("a byte that no text holds"), InputError);
  for (const char* text :
       {"%YAML:1.0\n---\n- camera_matrix\n",
        "%YAML:1.0\n---\ncamera_matr`x: !!opencv-matrix\n   rows: 3\n   :cosl 3\n   dt: d\n"
        "   data: [ 1. ]\n"})
    CHECK_THROWS_WITH_AS(read_cameras(folder.write("list.yml", text)),
                         doctest::Contains("list.yml:1: not an OpenCV YAML"), InputError);
  CHECK_THROWS_WITH_AS(read_cameras(folder.write("big.yml", many("# 89 123456\n", 400'000))),
                       doctest::Contains("larger than any"), InputError);
  CHECK_THROWS_WITH_AS(read_cameras(folder.write("text.yml", "hello\n")),
                       doctest::Contains("not a camera file of a known format (easymocap, "),
                       InputError);
}

TEST_CASE("camera formats: the docs list them all, and no other file is taken for one") {
  const std::string page =
      read_text_file(std::filesystem::path(MCDBN_SOURCE_DIR) / "docs/formats.md");
  for (const CameraFormat& format : camera_formats()) {
    CAPTURE(format.name);
    CHECK(page.find(fmt::format("| `{}` | ", format.name)) != std::string::npos);
    CHECK_FALSE(format.about.empty());
  }
  const ScratchFolder folder;
  CHECK(camera_format_of(folder.write("a.csv", "Hips_x_px,Hips_y_px\n1,2\n")) == nullptr);
  CHECK(camera_format_of(folder.write("a.json", "[{\"keypoints\": [1, 2, 3]}]")) == nullptr);
  CHECK(camera_format_of(folder / "none.toml") == nullptr);
}
