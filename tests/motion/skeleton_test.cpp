#include "mcdbn/motion/skeleton.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <sstream>

#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "shared_data.hpp"

using namespace mcdbn;

namespace {

using C = Channel;

Joint rotating_joint(std::vector<Channel> channels) {
  Joint joint;
  joint.name = "joint";
  joint.channels = std::move(channels);
  return joint;
}

Skeleton arm() {
  Skeleton skeleton;
  Joint root = rotating_joint(
      {C::x_position, C::y_position, C::z_position, C::z_rotation, C::x_rotation, C::y_rotation});
  root.name = "root";
  root.offset = {100, 100, 100};
  Joint elbow = rotating_joint({C::z_rotation, C::x_rotation, C::y_rotation});
  elbow.name = "elbow";
  elbow.parent = 0;
  elbow.offset = {2, 0, 0};
  Joint hand = rotating_joint({C::y_position});
  hand.name = "hand";
  hand.parent = 1;
  hand.offset = {3, 7, 0};
  hand.end_sites.push_back({0, 0, 4});
  skeleton.joints = {root, elbow, hand};
  return skeleton;
}

Eigen::Matrix3d random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  // One after the other: arguments would be drawn in an order of the compiler's own.
  const double z = normal(random), y = normal(random), x = normal(random), w = normal(random);
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

const std::vector<std::vector<Channel>> kOrders = {
    {C::x_rotation, C::y_rotation, C::z_rotation}, {C::x_rotation, C::z_rotation, C::y_rotation},
    {C::y_rotation, C::x_rotation, C::z_rotation}, {C::y_rotation, C::z_rotation, C::x_rotation},
    {C::z_rotation, C::x_rotation, C::y_rotation}, {C::z_rotation, C::y_rotation, C::x_rotation}};

}  // namespace

TEST_CASE("forward kinematics of a hand-computed arm") {
  const Skeleton skeleton = arm();
  RowVectorD channels(10);
  // Root at (1, 2, 3) turned 90° about z; elbow bent 90° about x; hand's y position replaces its 7.
  channels << 1, 2, 3, 90, 0, 0, 0, 90, 0, 5;
  const WorldPose pose = forward_kinematics(skeleton, channels);
  CHECK((pose.position[0] - Eigen::Vector3d(1, 2, 3)).norm() < 1e-12);
  CHECK((pose.position[1] - Eigen::Vector3d(1, 4, 3)).norm() < 1e-12);
  // Elbow's frame: x → world y, y → world z, z → world x.
  CHECK((pose.position[2] - Eigen::Vector3d(1, 7, 8)).norm() < 1e-12);
  CHECK((pose.world_from_joint[2] * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm() <
        1e-12);

  Motion motion{skeleton, 0.1, channels};
  const MatrixD positions = joint_positions(motion);
  REQUIRE(positions.rows() == 1);
  REQUIRE(positions.cols() == 9);
  CHECK(positions(0, 8) == doctest::Approx(8));
  CHECK_THROWS_AS(forward_kinematics(skeleton, RowVectorD::Zero(9)), ShapeError);
}

TEST_CASE("rotation channels multiply in the file's order") {
  const Joint joint = rotating_joint({C::z_rotation, C::x_rotation, C::y_rotation});
  const double angles[] = {30, 40, 50};
  const auto turn = [](double degrees, int axis) {
    return Eigen::AngleAxisd(degrees * M_PI / 180, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
  };
  const Eigen::Matrix3d expected = turn(30, 2) * turn(40, 0) * turn(50, 1);
  CHECK((local_rotation(joint, angles) - expected).norm() < 1e-12);
}

TEST_CASE("every order of axes gives back random rotations") {
  std::mt19937 random(1);
  for (const auto& order : kOrders) {
    const Joint joint = rotating_joint(order);
    for (int trial = 0; trial < 200; ++trial) {
      const Eigen::Matrix3d rotation = random_rotation(random);
      double angles[3];
      set_local_rotation(joint, rotation, nullptr, angles);
      CHECK((local_rotation(joint, angles) - rotation).norm() < 1e-9);
      CHECK(std::abs(angles[1]) <= 90 + 1e-9);
    }
  }
}

TEST_CASE("angles run on through ±180° and past a middle angle of 90°") {
  for (const auto& order : kOrders) {
    const Joint joint = rotating_joint(order);
    double previous[3] = {150, 60, -170};
    for (int frame = 1; frame <= 400; ++frame) {
      // The outer angles turn through several full turns, the middle one swings past 90° and back.
      const double truth[3] = {150 + 2.1 * frame, 60 + 50 * std::sin(frame * 0.0317),
                               -170 - 1.3 * frame};
      double angles[3];
      set_local_rotation(joint, local_rotation(joint, truth), previous, angles);
      for (int n = 0; n < 3; ++n) CHECK(angles[n] == doctest::Approx(truth[n]).epsilon(1e-6));
      std::copy(angles, angles + 3, previous);
    }
  }
}

TEST_CASE("gimbal lock reproduces the rotation and stays near the angles before") {
  for (const auto& order : kOrders) {
    for (const double middle : {90.0, -90.0}) {
      const Joint joint = rotating_joint(order);
      const double truth[3] = {35, middle, 20}, previous[3] = {33, 0.98 * middle, 19};
      const Eigen::Matrix3d rotation = local_rotation(joint, truth);
      double angles[3];
      set_local_rotation(joint, rotation, previous, angles);
      CHECK((local_rotation(joint, angles) - rotation).norm() < 1e-6);
      CHECK(std::abs(angles[0] - 35) < 3);
      CHECK(std::abs(angles[2] - 20) < 3);
      set_local_rotation(joint, rotation, nullptr, angles);
      CHECK((local_rotation(joint, angles) - rotation).norm() < 1e-6);
    }
  }
}

TEST_CASE("joints with fewer rotation channels take the nearest rotation they can express") {
  std::mt19937 random(2);
  SUBCASE("what they can express comes back") {
    const Joint hinge = rotating_joint({C::y_rotation});
    const double bend = -130, before = -500;
    double angle = 0;
    set_local_rotation(hinge, local_rotation(hinge, &bend), &before, &angle);
    CHECK(angle == doctest::Approx(-490));

    const Joint wrist = rotating_joint({C::z_rotation, C::y_position, C::x_rotation});
    const double truth[3] = {170, 12345, -100};
    double angles[3] = {0, 12345, 0};
    set_local_rotation(wrist, local_rotation(wrist, truth), nullptr, angles);
    CHECK((local_rotation(wrist, angles) - local_rotation(wrist, truth)).norm() < 1e-6);
    CHECK(angles[1] == 12345);  // positions are not its business
  }
  SUBCASE("no turn of either axis comes nearer to a random rotation") {
    const Joint joint = rotating_joint({C::x_rotation, C::y_rotation});
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::Matrix3d rotation = random_rotation(random);
      double found[2];
      set_local_rotation(joint, rotation, nullptr, found);
      const double distance = (local_rotation(joint, found) - rotation).norm();
      for (double a = -180; a < 180; a += 6) {
        for (double b = -180; b < 180; b += 6) {
          const double other[2] = {a, b};
          REQUIRE(distance <= (local_rotation(joint, other) - rotation).norm() + 1e-6);
        }
      }
    }
  }
  SUBCASE("a joint without rotation channels is left alone") {
    const Joint fixed = rotating_joint({C::x_position});
    double value = 3;
    set_local_rotation(fixed, random_rotation(random), nullptr, &value);
    CHECK(value == 3);
  }
}

TEST_CASE("the moving root is the last on the chain that travels in any clip") {
  Motion clip{arm(), 0.1, MatrixD::Zero(3, 10)};
  CHECK(moving_root({&clip}) == 0);  // nothing travels
  clip.channels(1, 3) = 90;          // turning is not travelling
  CHECK(moving_root({&clip}) == 0);
  Motion root_travels = clip, both_travel = clip;
  clip.channels(2, 9) = 1;
  CHECK(moving_root({&clip}) == 2);
  root_travels.channels(2, 1) = 1;
  CHECK(moving_root({&root_travels}) == 0);
  both_travel.channels(2, 1) = both_travel.channels(2, 9) = 1;
  CHECK(moving_root({&both_travel}) == 2);
  // A single clip whose root travels does not take the other clips' path away.
  CHECK(moving_root({&root_travels, &clip}) == 2);
  CHECK(moving_root({&clip, &root_travels}) == 2);
  const Motion still{arm(), 0.1, MatrixD::Zero(3, 10)};
  CHECK(moving_root({&still, &root_travels}) == 0);
}

TEST_CASE("Bandai's body is carried by the hips, also with clips whose joint_Root travels") {
  const std::string set = "bandai/set1/dataset-1_walk-back_";
  if (!test::have_shared_data(set + "normal_001.bvh", "the moving root of Bandai's clips")) return;
  const Motion usual = read_bvh(test::shared_data() / (set + "active_001.bvh")),
               travelling = read_bvh(test::shared_data() / (set + "normal_001.bvh"));
  const int hips = usual.skeleton.find("Hips");
  CHECK(moving_root({&usual}) == hips);
  CHECK(moving_root({&usual, &travelling}) == hips);
  CHECK(moving_root({&travelling}) == hips);
}

TEST_CASE("rest height") {
  const Skeleton skeleton = arm();
  CHECK(skeleton.channel_count() == 10);
  CHECK(skeleton.first_channel(2) == 9);
  CHECK(skeleton.find("hand") == 2);
  CHECK(skeleton.find("foot") == -1);
  // The hand has a position channel, so the body begins there and is its end site alone.
  CHECK(skeleton.rest_height() == doctest::Approx(4));
  Skeleton fixed = skeleton;
  fixed.joints[2].channels.clear();
  CHECK(fixed.rest_height(0) == doctest::Approx(5));
  CHECK(fixed.rest_height(1) == doctest::Approx(7));
  CHECK(fixed.rest_height(2) == doctest::Approx(4));
  CHECK(fixed.rest_height() == doctest::Approx(7));
}

TEST_CASE("forward kinematics equals another program's on walk01") {
  if (!test::have_shared_data("bvh_zoo/walk01_pos.csv", "walk01 forward kinematics")) return;
  const Motion motion = read_bvh(test::shared_data() / "bvh_zoo/walk01.bvh");
  std::istringstream csv(read_text_file(test::shared_data() / "bvh_zoo/walk01_pos.csv"));
  std::string line;
  REQUIRE(std::getline(csv, line));

  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string cell; std::getline(header, cell, ',');) names.push_back(cell);
  int frame = 0, compared = 0;
  for (; std::getline(csv, line) && !line.empty(); ++frame) {
    REQUIRE(frame < motion.frames());
    const WorldPose pose = forward_kinematics(motion.skeleton, motion.channels.row(frame));
    std::istringstream row(line);
    std::string cell;
    for (std::size_t column = 0; std::getline(row, cell, ','); ++column) {
      if (column == 0) continue;
      std::string name = names[column].substr(0, names[column].find('.'));
      const int axis = names[column][name.size() + 1] - 'x';
      const bool end_site = name.ends_with("_End");
      if (end_site) name.resize(name.size() - 4);
      const int joint = motion.skeleton.find(name);
      REQUIRE(joint >= 0);
      Eigen::Vector3d point = pose.position[joint];
      if (end_site) {
        point += pose.world_from_joint[joint] * motion.skeleton.joints[joint].end_sites.at(0);
      }
      CHECK(std::abs(point[axis] - std::stod(cell)) < 1.5e-5);  // five decimals are printed
      ++compared;
    }
  }
  CHECK(frame == motion.frames());
  CHECK(compared == motion.frames() * 3 * (motion.skeleton.joint_count() + 5));
}
