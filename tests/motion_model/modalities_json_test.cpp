#include "motion_model/modalities_json.hpp"

#include <doctest/doctest.h>

#include "corpus/humanoid_clips.hpp"
#include "features/clip_modalities.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion/synthetic_motion.hpp"

namespace modalities_json_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

const Eigen::Matrix3d kCamera = camera_rotation(30, 10);

Motion there_and_back(const PoseFeatures& features, const Motion& motion) {
  return features.decode(features.encode(motion, kCamera), kCamera, motion.skeleton, motion.fps(),
                         MatrixD::Zero(motion.frames(), 3));
}

}  // namespace

TEST_CASE("pose features: JSON keeps every bit, and damage is noticed") {
  const Motion motion = swinging(small_body_below_still_root(), 20, 30, {"RFoot"});
  const PoseFeatures features = PoseFeatures::fit({&motion});
  const nlohmann::json json = pose_features_json(features);
  const nlohmann::json parsed = nlohmann::json::parse(json.dump());
  const PoseFeatures copy = pose_features_from({parsed, "file"});
  CHECK(pose_features_json(copy) == json);
  CHECK(copy.encode(motion, kCamera) == features.encode(motion, kCamera));
  CHECK(there_and_back(copy, motion).channels == there_and_back(features, motion).channels);
  for (const char* key : {"skeleton", "root", "joints", "constant_channels"}) {
    nlohmann::json damaged = json;
    damaged.erase(key);
    CHECK_THROWS_AS(pose_features_from({damaged, "file"}), InputError);
  }
  nlohmann::json damaged = json;
  damaged["joints"].push_back(99);
  CHECK_THROWS_AS(pose_features_from({damaged, "file"}), InputError);
}

TEST_CASE("pose features: a model of the humanoid with Z X Y answers the same, with new orders") {
  const Motion motion = humanoid_clip(50, 100, 30).motion;  // elbows and knees have no feature
  const PoseFeatures features = PoseFeatures::fit({&motion});
  REQUIRE(features.joints().size() < 19);
  const Motion fixed = on_former_orders({features.skeleton(), 1.0 / 30, features.fixed_channels()});
  nlohmann::json json = pose_features_json(features);
  const nlohmann::json was = json;
  json["skeleton"] = bvh_header_text(fixed.skeleton);
  json["constant_channels"] =
      std::vector<double>(fixed.channels.data(), fixed.channels.data() + fixed.channels.size());
  REQUIRE(json["skeleton"] != was["skeleton"]);
  const Motion former = on_former_orders(motion);
  for (const PoseFeatures& other :
       {pose_features_from({json, "file"}), PoseFeatures::fit({&former, &motion})}) {
    CHECK(pose_features_json(other)["skeleton"] == was["skeleton"]);
    CHECK(is_humanoid(other.skeleton()));
    CHECK(other.joints() == features.joints());
    CHECK((other.encode(former, kCamera) - features.encode(motion, kCamera)).norm() < 1e-9);
    for (const Motion* own : {&motion, &former})
      CHECK(largest_difference(there_and_back(other, *own), there_and_back(features, motion)) <
            1e-9);
  }
}

TEST_CASE("modalities: JSON keeps the level view; a file that does not give it has none") {
  const Motion motion = swinging(small_body(), 20);
  Modalities modalities = modalities_of({motion}, {});
  for (const bool level : {true, false}) {
    modalities.level_view = level;
    nlohmann::json json = modalities_json(modalities);
    CHECK(modalities_from({json, "file"}).level_view == level);
    json.erase("level_view");
    CHECK_FALSE(modalities_from({json, "file"}).level_view);
  }
}

TEST_CASE("modalities: JSON keeps the directions; a file that does not give them has one") {
  Modalities modalities = modalities_of({swinging(small_body(), 20)}, {});
  modalities.directions = 7;
  nlohmann::json json = modalities_json(modalities);
  CHECK(modalities_from({json, "file"}).directions == 7);
  json.erase("directions");
  CHECK(modalities_from({json, "file"}).directions == 1);
}

}  // namespace modalities_json_test
