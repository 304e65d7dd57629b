#include "fitting/usual_body.hpp"

#include <doctest/doctest.h>

#include "mcdbn/motion/humanoid.hpp"
#include "motion/body_size.hpp"

namespace usual_body_test {

using namespace mcdbn;

namespace {

double length(const Skeleton& skeleton, JointRole role) {
  return skeleton.joints[static_cast<std::size_t>(humanoid_roles().joint(role))].offset.norm();
}

}  // namespace

TEST_CASE("usual body: as tall as the humanoid, alike on both sides, every bone on its way") {
  const Skeleton &was = canonical_humanoid(), now = usual_body(was);
  DOCTEST_CHECK(is_humanoid(now));
  DOCTEST_CHECK(body_height(now) == doctest::Approx(body_height(was)).epsilon(0.005));
  for (const auto& [left, right] : {std::pair{JointRole::left_hip, JointRole::right_hip},
                                    {JointRole::left_knee, JointRole::right_knee},
                                    {JointRole::left_ankle, JointRole::right_ankle},
                                    {JointRole::left_clavicle, JointRole::right_clavicle},
                                    {JointRole::left_shoulder, JointRole::right_shoulder},
                                    {JointRole::left_elbow, JointRole::right_elbow},
                                    {JointRole::left_wrist, JointRole::right_wrist}})
    DOCTEST_CHECK(length(now, left) == doctest::Approx(length(now, right)));
  // What one orientation turns has one length in the fit: all of it changes alike.
  for (const auto& [one, other] : {std::pair{JointRole::spine, JointRole::left_hip},
                                   {JointRole::neck, JointRole::left_clavicle}})
    DOCTEST_CHECK(length(now, one) / length(was, one) ==
                  doctest::Approx(length(now, other) / length(was, other)));
  for (std::size_t joint = 0; joint < now.joints.size(); ++joint)
    DOCTEST_CHECK(now.joints[joint].offset.cross(was.joints[joint].offset).norm() < 1e-9);
}

}  // namespace usual_body_test
