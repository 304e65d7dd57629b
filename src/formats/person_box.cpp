#include "formats/person_box.hpp"

namespace mcdbn {

PersonBox box_of(const SeenPerson& person) {
  using Point = Eigen::Vector2d;
  PersonBox box{Point::Constant(1e300), Point::Constant(-1e300)};
  bool seen = false;
  for (std::size_t joint = 0; joint < person.x_px.size(); ++joint) {
    const Point at(person.x_px[joint], person.y_px[joint]);
    if (!(person.confidence[joint] > 0)) continue;
    box.least = box.least.cwiseMin(at);
    box.most = box.most.cwiseMax(at);
    seen = true;
  }
  return seen ? box : PersonBox{Point::Zero(), Point::Zero()};
}

}  // namespace mcdbn
