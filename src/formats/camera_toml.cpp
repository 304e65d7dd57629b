#include "formats/camera_toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/toml_keys.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// Numbers of a list, or of a list of lists, row by row.
void add_numbers(const toml::node& node, const std::string& where, std::vector<double>& numbers) {
  if (const toml::array* list = node.as_array()) {
    for (const toml::node& entry : *list) add_numbers(entry, where, numbers);
  } else if (const auto number = node.value<double>(); number && !node.is_boolean()) {
    numbers.push_back(*number);
  } else {
    throw InputError(where + " holds something that is not a number; correct it");
  }
}

/// One section, whose errors name it and the key's line.
class Section {
 public:
  Section(const CameraSource& source, TomlSection section)
      : source_(source), section_(std::move(section)) {}

  bool has(const std::string& key) const { return section_.table->contains(key); }

  std::string where(const std::string& key) const {
    const toml::node* node = section_.table->get(key);
    const auto line = (node ? node->source() : section_.table->source()).begin.line;
    return fmt::format("{}:{}: {}: {}", source_.path.string(), line, section_.name, key);
  }

  std::vector<double> numbers(const std::string& key) const {
    const toml::node* node = section_.table->get(key);
    if (!node) throw InputError(where(key) + " is missing; add it");
    std::vector<double> result;
    add_numbers(*node, where(key), result);
    return result;
  }

  std::vector<double> numbers(const std::string& key, std::size_t count,
                              const std::string& what) const {
    std::vector<double> result = numbers(key);
    if (result.size() != count)
      throw InputError(fmt::format("{} has {} numbers; give {}", where(key), result.size(), what));
    return result;
  }

  bool on(const std::string& key) const { return (*section_.table)[key].value_or(false); }

  std::string name() const {
    return (*section_.table)["name"].value<std::string>().value_or(section_.name);
  }

 private:
  const CameraSource& source_;
  TomlSection section_;
};

TomlCamera camera_of(const Section& section) {
  TomlCamera result;
  result.name = section.name();
  Camera& camera = result.camera;
  const auto size = section.numbers("size", 2, "width and height in pixels");
  camera.width_px = pixels_of(size[0], section.where("size"));
  camera.height_px = pixels_of(size[1], section.where("size"));
  const auto matrix = section.numbers("matrix", 9, "[[fx, 0, cx], [0, fy, cy], [0, 0, 1]]");
  set_intrinsics(camera,
                 Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.data()),
                 section.where("matrix"));
  const bool lens = section.has("distortions");
  (section.on("fisheye") ? set_fisheye : set_distortion)(
      camera, lens ? section.numbers("distortions") : std::vector<double>{},
      section.where("distortions"));
  result.camera_from_world = rotation_of(section.numbers("rotation"), section.where("rotation"));
  result.translation = Eigen::Vector3d(section.numbers("translation", 3, "x, y and z").data());
  if (!result.translation.allFinite())
    throw InputError(section.where("translation") +
                     " holds a number that is not finite; correct it");
  return result;
}

}  // namespace

bool is_toml(const CameraSource& source) {
  const auto holds = [&](const char* word) { return source.text.find(word) != std::string::npos; };
  const auto first = source.text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return first != std::string::npos &&
         std::string_view("{<%").find(source.text[first]) == std::string_view::npos &&
         holds("matrix") && holds("[") && holds("=");
}

toml::table parse_toml(const CameraSource& source) {
  if (const auto line = line_of_long_key(source.text))
    throw InputError(fmt::format("{}:{}: a key of more parts than any camera file's",
                                 source.path.string(), *line));
  try {
    return toml::parse(source.text);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}: no readable TOML from here on", source.path.string(),
                                 error.source().begin.line));
  }
}

std::vector<TomlSection> camera_sections(const toml::table& file) {
  std::vector<TomlSection> sections;
  const auto add = [&](const toml::table& parent) {
    for (const auto& [key, node] : parent)
      if (const toml::table* table = node.as_table(); table && table->contains("matrix"))
        sections.push_back({std::string(key.str()), table});
  };
  add(file);
  if (const toml::table* cameras = file["cameras"].as_table()) add(*cameras);
  std::ranges::stable_sort(
      sections, {}, [](const TomlSection& section) { return section.table->source().begin.line; });
  return sections;
}

std::vector<TomlCamera> toml_cameras(const CameraSource& source) {
  const toml::table file = parse_toml(source);
  std::vector<TomlCamera> cameras;
  for (const TomlSection& section : camera_sections(file))
    cameras.push_back(camera_of(Section(source, section)));
  return cameras;
}

double largest_distance(const std::vector<TomlCamera>& cameras) {
  double largest = 0;
  for (const TomlCamera& camera : cameras) largest = std::max(largest, camera.translation.norm());
  return largest;
}

CameraRig rig_of(const std::vector<TomlCamera>& cameras, WorldUp up, double unit_m) {
  CameraRig rig;
  for (const TomlCamera& read : cameras) {
    NamedCamera named{read.name, read.camera};
    named.camera.unit_m = unit_m;
    set_pose(named.camera, read.camera_from_world, read.translation, up);
    rig.cameras.push_back(std::move(named));
  }
  return rig;
}

CameraRig rig_z_up_in_metres(const CameraSource& source) {
  CameraRig rig = rig_of(toml_cameras(source), WorldUp::z, 1.0);
  rig.assumed = {"its world is z-up and in metres"};
  return rig;
}

}  // namespace mcdbn
