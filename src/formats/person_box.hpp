#pragma once

#include <Eigen/Core>

#include "formats/seen_people.hpp"

namespace mcdbn {

/// Bounding box of a person's joints in one frame.
struct PersonBox {
  Eigen::Vector2d least, most;
  double area() const { return (most - least).prod(); }
  double diagonal() const { return (most - least).norm(); }
  Eigen::Vector2d centre() const { return (least + most) / 2; }
};

/// Bounding box of the joints that were seen; without any it is at the origin, of no extent.
PersonBox box_of(const SeenPerson& person);

}  // namespace mcdbn
