#include "formats/asf_amc.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <map>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/motion_file.hpp"
#include "motion/body_size.hpp"
#include "shared_data.hpp"

using namespace mcdbn;

namespace {

constexpr const char* kAsf =
    "# made by hand\n:version 1.10\n:name TEST\n:units\n  mass 1.0\n  length 0.5\n  angle deg\n"
    ":documentation\n   begin here {and there}\n:root\n   order TX TY TZ RX RY RZ\n   axis XYZ\n"
    "   position 0 1 0\n   orientation 0 0 0\n:bonedata\n"
    "  begin\n     id 1\n     name thigh\n     direction 0 -2 0\n     length 4\n"
    "     axis 0 0 90 XYZ\n    dof rx rz\n    limits (-160.0 20.0)\n           (-inf inf)\n  end\n"
    "  begin\n     id 2\n     name shin\n     direction 1.5e-011 -1 0\n     length 3\n"
    "     axis 0 0 0 XYZ\n  end\n"
    ":hierarchy\n  begin\n    root thigh\n    thigh shin\n  end\n";
constexpr const char* kAmc =
    "#!OML:ASF\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 1 2 3 0 90 0\nthigh 90 0\n"
    "2\nroot 1 2 3 0 0 0 # nothing\nthigh\t-1.6e-014 30\n";

Motion parsed(const std::string& asf, const std::string& amc) {
  return parse_asf_amc(asf, "a.asf", amc, "a.amc", nullptr);
}

std::string changed_text(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// Largest and median distance of joints of both, in millimetres.
struct Distance {
  double largest = 0, median = 0;
};

/// @param names joints of a and what b calls them  @param every so many frames one is compared
Distance distance_mm(const Motion& a, const Motion& b, int skipped_of_b, double mm_of_a,
                     double mm_of_b, const std::map<std::string, std::string>& names,
                     int every = 1) {
  const MatrixD one = mm_of_a * joint_positions(a), other = mm_of_b * joint_positions(b);
  std::vector<double> distances;
  for (const auto& [own, theirs] : names) {
    const int i = a.skeleton.find(own), j = b.skeleton.find(theirs);
    REQUIRE(i >= 0);
    REQUIRE(j >= 0);
    for (int t = 0; t < a.frames(); t += every)
      distances.push_back(
          (one.block<1, 3>(t, 3 * i) - other.block<1, 3>(t + skipped_of_b, 3 * j)).norm());
  }
  std::ranges::sort(distances);
  return {distances.back(), distances[distances.size() / 2]};
}

}  // namespace

TEST_CASE("ASF and AMC: bones turn about their own axes, and an inch is 2.54 cm") {
  const Motion motion = parsed(kAsf, kAmc);
  REQUIRE(motion.frames() == 2);
  CHECK(motion.fps() == doctest::Approx(120));
  REQUIRE(motion.skeleton.joint_count() == 3);
  CHECK(motion.skeleton.joints[2].name == "shin");
  constexpr double kUnit_cm = 5.08;
  REQUIRE(motion.skeleton.joints[2].end_sites.size() == 1);
  CHECK(motion.skeleton.joints[2].end_sites[0].norm() == doctest::Approx(3 * kUnit_cm));
  const MatrixD at = joint_positions(motion) / kUnit_cm;
  // The thigh's x axis is the world's y: its turn by 90 degrees about it leaves it hanging.
  CHECK((at.block<1, 3>(0, 0) - Eigen::RowVector3d(1, 3, 3)).norm() < 1e-9);
  CHECK((at.block<1, 3>(0, 6) - Eigen::RowVector3d(1, -1, 3)).norm() < 1e-9);
  // By 30 degrees about z it swings to +x.
  CHECK((at.block<1, 3>(1, 6) - Eigen::RowVector3d(3, 3 - 4 * std::cos(EIGEN_PI / 6), 3)).norm() <
        1e-9);
  // The root is turned by 90 degrees about y: what hangs on it is seen from the side.
  const WorldPose pose = forward_kinematics(motion.skeleton, motion.channels.row(0));
  CHECK((pose.world_from_joint[0] * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitZ()).norm() <
        1e-9);
  // In radians the same.
  const Motion radians =
      parsed(kAsf, changed_text(changed_text(changed_text(kAmc, ":DEGREES", ":RADIANS"), "0 90 0",
                                             "0 1.5707963267948966 0"),
                                "thigh 90 0", "thigh 1.5707963267948966 0"));
  CHECK((radians.channels.row(0) - motion.channels.row(0)).norm() < 1e-9);
}

TEST_CASE("ASF and AMC: the order of axes and of freedoms counts") {
  const std::string asf = changed_text(changed_text(kAsf, "dof rx rz", "dof rz rx"),
                                       "axis 0 0 90 XYZ", "axis 20 30 40 ZXY");
  const Motion motion = parsed(asf, changed_text(kAmc, "thigh 90 0", "thigh 50 60"));
  const auto turn = [](double angle_deg, int axis) {
    return Eigen::AngleAxisd(angle_deg * EIGEN_PI / 180, Eigen::Vector3d::Unit(axis))
        .toRotationMatrix();
  };
  const Eigen::Matrix3d axes = turn(40, 1) * turn(30, 0) * turn(20, 2);
  const Eigen::Matrix3d wanted = axes * turn(60, 0) * turn(50, 2) * axes.transpose();
  const int first = motion.skeleton.first_channel(1);
  const Eigen::Matrix3d got =
      local_rotation(motion.skeleton.joints[1], motion.channels.row(0).data() + first);
  CHECK((got - wanted).norm() < 1e-9);
}

TEST_CASE("ASF and AMC: what is wrong is named with its file and line") {
  struct Case {
    bool asf;
    const char *from, *to, *message;
  };
  for (const Case& c :
       {Case{true, "length 0.5", "length 0", "a.asf:6: the length unit is not above 0"},
        Case{true, "angle deg", "angle grad", "a.asf:7: angles are in 'grad'"},
        Case{true, "axis XYZ", "axis XYX", "a.asf:12: 'XYX' is no order"},
        Case{true, "direction 0 -2 0", "direction 0 down 0", "a.asf:19:"},
        Case{true, "dof rx rz", "dof rx l", "a.asf:22: 'l' is no freedom"},
        Case{true, "dof rx rz", "dof rx rx", "a.asf:22: 'rx' comes twice"},
        Case{true, "name shin", "name thigh", "a second bone 'thigh'"},
        Case{true, "name shin", "id 3", "a bone without a name"},
        Case{true, "begin\n     id 2", "bgin\n     id 2",
             "a.asf:26: 'bgin' where a bone begins; 'begin' is wanted"},
        Case{true, "thigh shin", "thigh foot", "no bone is called 'foot'"},
        Case{true, "    thigh shin\n", "", "'shin' hangs on nothing"},
        Case{true, "thigh shin", "shin thigh", "second parent"},

        Case{false, "thigh 90 0", "thigh 90", "a.amc:6: thigh has fewer numbers than freedoms (2)"},
        Case{false, "thigh 90 0", "thigh 90 0 1", "a.amc:6: thigh has more numbers"},
        Case{false, "thigh 90 0", "thigh 90 x", "a.amc:6:"},
        Case{false, "thigh 90 0\n", "", "a.amc:4: the frame has no line of thigh"},
        Case{false, "thigh 90 0", "hand 90 0", "a.amc:6: the skeleton has no bone 'hand'"},
        Case{false, "thigh 90 0", "thigh 90 0\nthigh 90 0", "a.amc:7: 'thigh' comes twice"},
        Case{false, "\n1\n", "\nfirst\n", "a.amc:4: 'first' where the number of a frame"}}) {
    CAPTURE(c.to);
    CHECK_THROWS_WITH_AS(parsed(c.asf ? changed_text(kAsf, c.from, c.to) : kAsf,
                                c.asf ? kAmc : changed_text(kAmc, c.from, c.to)),
                         doctest::Contains(c.message), InputError);
  }
  CHECK_THROWS_WITH_AS(parsed(kAsf, ":DEGREES\n"), doctest::Contains("no frame"), InputError);
  CHECK_THROWS_WITH_AS(parsed("", kAmc), doctest::Contains("no bone in a :bonedata"), InputError);
}

TEST_CASE("motion files: an AMC finds its skeleton beside it") {
  const test::ScratchFolder folder;
  const auto amc = folder.write("16_15.amc", kAmc);
  CHECK_THROWS_WITH_AS(read_motion(amc), doctest::Contains("its skeleton is missing"), InputError);
  const auto only = folder.write("other.ASF", kAsf);
  folder.write("._other.asf", "not an ASF");  // as macOS puts beside it
  CHECK(read_motion(amc).frames() == 2);
  folder.write("1.asf", kAsf);
  CHECK_THROWS_AS(read_motion(amc), InputError);  // neither is its own
  std::vector<std::string> warnings;
  folder.write("16.asf", changed_text(kAsf, "length 0.5", "length 1"));
  const Motion of_person = read_motion(amc, &warnings);
  CHECK(of_person.skeleton.joints[2].end_sites[0].norm() == doctest::Approx(3 * 2.54));
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].find("120 Hz") != std::string::npos);
  folder.write("16_15.asf", kAsf);
  CHECK(read_motion(amc).skeleton.joints[2].end_sites[0].norm() == doctest::Approx(3 * 5.08));
  CHECK_THROWS_WITH_AS(read_motion(only), doctest::Contains("is a skeleton"), InputError);
  CHECK(is_motion_file("a/B.AMC"));
  CHECK(is_motion_file("a/b.bvh"));
  CHECK_FALSE(is_motion_file("a/b.asf"));
  CHECK_FALSE(is_motion_file("a/._b.bvh"));
  // Written as BVH it is the same motion.
  const Motion back = parse_bvh(bvh_text(of_person), "back.bvh");
  CHECK((joint_positions(back) - joint_positions(of_person)).cwiseAbs().maxCoeff() < 1e-3);
}

TEST_CASE("motion files: the skeleton alone is that of the motion, whatever the frames are") {
  const test::ScratchFolder folder;
  folder.write("07.asf", kAsf);
  const auto amc = folder.write("07_01.amc", kAmc);
  const Motion motion = read_motion(amc);
  const std::string wanted = bvh_header_text(motion.skeleton);
  CHECK(bvh_header_text(read_skeleton(amc)) == wanted);
  const std::string text = bvh_text(motion);
  const auto cut = folder.write("cut.bvh", text.substr(0, text.find("MOTION") + 6));
  CHECK_THROWS_AS(read_motion(cut), InputError);
  CHECK(bvh_header_text(read_skeleton(cut)) == wanted);
  CHECK_THROWS_AS(read_skeleton(folder.write("no.bvh", "no skeleton")), InputError);
  CHECK_THROWS_AS(read_skeleton(folder / "absent.bvh"), InputError);
}

TEST_CASE("ASF and AMC: real takes are where the BVH of the same take has them") {
  const std::string folder = "formats/cmu_asf_amc";
  if (!test::have_shared_data(folder, "ASF and AMC")) return;
  const auto file = [&](const char* name) { return test::shared_data() / folder / name; };
  const Motion walk = read_motion(file("16_15.amc")), same = read_bvh(file("16_15.bvh"));
  REQUIRE(walk.frames() == same.frames());
  std::map<std::string, std::string> names;
  for (const Joint& joint : same.skeleton.joints) names[joint.name] = joint.name;
  CHECK(names.size() == 29);
  // Of every four frames of this BVH three have angles drawn straight between those around them,
  // which leads an arm that hangs at a singularity astray by 42 cm.
  const Distance in_cm = distance_mm(walk, same, 0, 10, 10, names, 4);
  CHECK(in_cm.median < 0.01);
  CHECK(in_cm.largest < 0.01);
  CHECK(distance_mm(walk, same, 0, 10, 10, {{"thorax", "thorax"}, {"rfemur", "rfemur"}}).largest <
        0.1);

  // One T-pose first, ASF units, other names: one of them is 2.54 cm over 0.45.
  const Motion jump = read_motion(file("01_01_first200.amc")),
               other = read_bvh(file("01_01_first201.bvh"));
  REQUIRE(jump.frames() + 1 == other.frames());
  constexpr double kUnit_mm = 25.4 / 0.45;
  const Distance in_units = distance_mm(jump, other, 1, 10, kUnit_mm,
                                        {{"root", "Hips"},
                                         {"lfemur", "LeftUpLeg"},
                                         {"ltibia", "LeftLeg"},
                                         {"rfoot", "RightFoot"},
                                         {"upperback", "Spine"},
                                         {"thorax", "Spine1"}});
  CHECK(in_units.largest < 0.01);
  // That BVH leaves out the bone between thorax and neck, 2.06488 units.
  const Distance above =
      distance_mm(jump, other, 1, 10, kUnit_mm, {{"head", "Head"}, {"lradius", "LeftForeArm"}});
  CHECK(above.largest == doctest::Approx(2.06488 * kUnit_mm).epsilon(1e-3));
  CHECK(above.median == doctest::Approx(above.largest).epsilon(1e-3));

  for (const char* name : {"11_01_first300.amc", "walk_takeo_01.amc"}) {
    CAPTURE(name);
    const Motion motion = read_motion(file(name));
    CHECK(motion.frames() > 200);
    CHECK(motion.channels.allFinite());
    CHECK(body_height(motion.skeleton) > 140);
    CHECK(body_height(motion.skeleton) < 210);
  }
}
