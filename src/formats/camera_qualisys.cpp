// Qualisys' calibration (*.qca.txt): XML whose cameras have their numbers as attributes. Pixels and
// lens are in 1/64, the place is the camera's centre in millimetres, r is the rotation from the
// world, z up, to a camera with y up and z backwards. Checked against Pose2Sim's TOML of one
// session.

#include <fmt/format.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <sstream>

#include "formats/camera_formats.hpp"
#include "formats/camera_parts.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

using boost::property_tree::ptree;
constexpr double kUnit_px = 1.0 / 64;

bool recognises(const CameraSource& source) {
  return source.text.find("<calibration") != std::string::npos &&
         source.text.find("<intrinsic") != std::string::npos;
}

/// A camera's element, whose errors name it.
class Element {
 public:
  Element(const CameraSource& source, const ptree& camera)
      : camera_(camera),
        name_(camera.get("<xmlattr>.serial", "")),
        where_(place_of(source.path, source.text, "serial=\"" + name_ + '"') + name_ + ": ") {}

  const std::string& name() const { return name_; }
  std::string where(const std::string& of) const { return where_ + of; }

  double number(const std::string& element, const std::string& attribute) const {
    const auto found = camera_.get_optional<double>(element + ".<xmlattr>." + attribute);
    if (!found || !std::isfinite(*found))
      throw InputError(where(fmt::format("{} {}", element, attribute)) +
                       " is missing or not a number; correct it");
    return *found;
  }

 private:
  const ptree& camera_;
  std::string name_, where_;
};

Camera camera_of(const Element& element) {
  Camera camera;
  const auto lens = [&](const char* name) { return kUnit_px * element.number("intrinsic", name); };
  const auto edge = [&](const char* name) { return element.number("fov_video", name); };
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix(0, 0) = lens("focalLengthU");
  matrix(1, 1) = lens("focalLengthV");
  // The centre is given from the corner of the sensor, of which the image may be a part.
  matrix(0, 2) = lens("centerPointU") - edge("left");
  matrix(1, 2) = lens("centerPointV") - edge("top");
  set_intrinsics(camera, matrix, element.where("intrinsic"));
  // Tangental is how the file spells it.
  camera.distortion = {lens("radialDistortion1"), lens("radialDistortion2"),
                       lens("tangentalDistortion1"), lens("tangentalDistortion2"),
                       lens("radialDistortion3")};
  const auto span = [&](const char* low, const char* high) {
    return pixels_of(edge(high) - edge(low) + 1, element.where("fov_video"));
  };
  camera.width_px = span("left", "right");
  camera.height_px = span("top", "bottom");
  std::vector<double> turn;
  for (const char* name : {"r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"})
    turn.push_back(element.number("transform", name));
  const Eigen::Matrix3d rotation =
      Eigen::Vector3d(1, -1, -1).asDiagonal() * rotation_of(turn, element.where("transform"));
  const Eigen::Vector3d centre(element.number("transform", "x"), element.number("transform", "y"),
                               element.number("transform", "z"));
  set_pose(camera, rotation, -rotation * centre, WorldUp::z);
  camera.unit_m = 0.001;
  return camera;
}

CameraRig read(const CameraSource& source) {
  ptree file;
  try {
    std::istringstream text(source.text);
    boost::property_tree::read_xml(text, file);
  } catch (const boost::property_tree::xml_parser_error& error) {
    throw InputError(fmt::format("{}:{}: not XML as Qualisys writes it", source.path.string(),
                                 std::max(1UL, error.line())));
  }
  CameraRig rig;
  rig.assumed = {"its world is z-up and in millimetres"};
  const auto cameras = file.get_child_optional("calibration.cameras");
  if (!cameras) return rig;
  for (const auto& [tag, camera] : *cameras) {
    if (tag != "camera") continue;
    const Element element(source, camera);
    rig.cameras.push_back({element.name(), camera_of(element)});
    if (camera.get("<xmlattr>.viewrotation", "0") != "0")
      rig.assumed.push_back(element.name() +
                            " is shown turned; pixels are taken to be those of its sensor");
  }
  return rig;
}

}  // namespace

CameraFormat qualisys_camera_format() {
  return {"qualisys", "Qualisys' calibration (XML), world z-up, millimetres", recognises, read};
}

}  // namespace mcdbn
