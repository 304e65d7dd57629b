#include "formats/asf_skeleton.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "base/numbers.hpp"
#include "formats/bvh_parser.hpp"

namespace mcdbn {
namespace {

using bvh::Cursor, bvh::same_word;

std::optional<int> freedom_of(std::string_view word) {
  constexpr std::array<std::string_view, 6> kWords{"rx", "ry", "rz", "tx", "ty", "tz"};
  const auto found =
      std::ranges::find_if(kWords, [&](std::string_view known) { return same_word(known, word); });
  if (found == kWords.end()) return std::nullopt;
  return static_cast<int>(found - kWords.begin());
}

/// "XYZ" as 0, 1, 2.
std::vector<int> axes_order(const Cursor& cursor, std::string_view word) {
  std::vector<int> order;
  for (const char letter : word) {
    const auto at = std::string_view("XYZxyz").find(letter);
    if (at != std::string_view::npos) order.push_back(static_cast<int>(at % 3));
  }
  std::vector<int> sorted = order;
  std::ranges::sort(sorted);
  if (word.size() != 3 || sorted != std::vector{0, 1, 2})
    cursor.fail(fmt::format("{} is no order of three axes; give XYZ or another", shown(word)));
  return order;
}

Eigen::Vector3d three(Cursor& cursor, std::string_view what) {
  const double x = cursor.number(what), y = cursor.number(what);
  return {x, y, cursor.number(what)};
}

class AsfParser {
 public:
  AsfParser(std::string_view text, const std::string& name) : cursor_(text, name, nullptr) {
    bones_.push_back({});
    bones_[0].name = "root";
  }

  AsfSkeleton parse() {
    std::string_view word = cursor_.next();
    while (!word.empty()) {
      if (same_word(word, ":units"))
        word = parse_units();
      else if (same_word(word, ":root"))
        word = parse_root();
      else if (same_word(word, ":bonedata"))
        word = parse_bones();
      else if (same_word(word, ":hierarchy"))
        word = parse_hierarchy();
      else
        word = cursor_.next();
    }
    if (bones_.size() < 2)
      cursor_.fail("no bone in a :bonedata section; an ASF skeleton is wanted");
    return assembled();
  }

 private:
  static bool opens_section(std::string_view word) { return word.empty() || word.front() == ':'; }

  std::string_view parse_units() {
    std::string_view word = cursor_.next();
    for (; !opens_section(word); word = cursor_.next()) {
      if (same_word(word, "length")) {
        const double length = cursor_.number("the length unit");
        if (!(length > 0)) cursor_.fail("the length unit is not above 0");
        constexpr double kInch_cm = 2.54;
        skeleton_.cm_per_unit = kInch_cm / length;
      } else if (same_word(word, "angle")) {
        const std::string_view unit = cursor_.next();
        if (!same_word(unit, "deg") && !same_word(unit, "rad"))
          cursor_.fail(fmt::format("angles are in {}; deg or rad is wanted", shown(unit)));
        degrees_per_angle_ = same_word(unit, "rad") ? 1 / kRadiansPerDegree : 1;
      } else {
        cursor_.rest_of_line();
      }
    }
    return word;
  }

  std::string_view parse_root() {
    AsfBone& root = bones_[0];
    std::vector<int> order{0, 1, 2};
    Eigen::Vector3d orientation{0, 0, 0};
    std::string_view word = cursor_.next();
    for (; !opens_section(word); word = cursor_.next()) {
      if (same_word(word, "order"))
        root.freedoms = freedoms(true);
      else if (same_word(word, "axis"))
        order = axes_order(cursor_, cursor_.next());
      else if (same_word(word, "position"))
        position_ = three(cursor_, "the root's position");
      else if (same_word(word, "orientation"))
        orientation = three(cursor_, "the root's orientation");
      else
        cursor_.rest_of_line();
    }
    root.axes = turned(order, orientation);
    return word;
  }

  std::string_view parse_bones() {
    std::string_view word = cursor_.next();
    for (; !opens_section(word); word = cursor_.next()) {
      if (!same_word(word, "begin"))
        cursor_.fail(fmt::format("{} where a bone begins; 'begin' is wanted", shown(word)));
      add_bone();
    }
    return word;
  }

  void add_bone() {
    AsfBone bone;
    Eigen::Vector3d direction{0, 0, 0};
    double length = 0;
    const int line = cursor_.line();
    for (std::string_view word = cursor_.next(); !same_word(word, "end"); word = cursor_.next()) {
      if (opens_section(word)) cursor_.fail_at(line, "a bone begins here and never ends");
      if (same_word(word, "name")) {
        bone.name = cursor_.next();
      } else if (same_word(word, "direction")) {
        direction = three(cursor_, "a direction");
      } else if (same_word(word, "length")) {
        length = cursor_.number("a length");
      } else if (same_word(word, "axis")) {
        const Eigen::Vector3d angles = three(cursor_, "an axis angle");
        bone.axes = turned(axes_order(cursor_, cursor_.next()), angles);
      } else if (same_word(word, "dof")) {
        bone.freedoms = freedoms(false);
      } else {
        cursor_.rest_of_line();
      }
    }
    if (bone.name.empty()) cursor_.fail_at(line, "a bone without a name");
    if (!names_.insert(bone.name).second)
      cursor_.fail_at(line, fmt::format("a second bone {}", shown(bone.name)));
    const double norm = direction.norm();
    if (norm > 0) bone.end_cm = direction / norm * length;  // scaled once the unit is known
    bones_.push_back(std::move(bone));
  }

  std::vector<int> freedoms(bool may_move) {
    std::vector<int> result;
    while (!cursor_.at_line_end()) {
      const std::string_view word = cursor_.next();
      const auto freedom = freedom_of(word);
      if (!freedom || (!may_move && *freedom > 2))
        cursor_.fail(fmt::format("{} is no freedom that is read here; {} are", shown(word),
                                 may_move ? "RX RY RZ TX TY TZ" : "rx ry rz"));
      if (std::ranges::find(result, *freedom) != result.end())
        cursor_.fail(fmt::format("{} comes twice", shown(word)));
      result.push_back(*freedom);
    }
    return result;
  }

  std::string_view parse_hierarchy() {
    std::string_view word = cursor_.next();
    for (; !opens_section(word); word = cursor_.next()) {
      if (same_word(word, "begin") || same_word(word, "end")) continue;
      const int parent = index_of(word);
      while (!cursor_.at_line_end()) {
        const int child = index_of(cursor_.next());
        if (child == 0 || parents_.contains(child))
          cursor_.fail(fmt::format("{} has a second parent", shown(bones_[child].name)));
        parents_[child] = parent;
      }
    }
    return word;
  }

  int index_of(std::string_view name) const {
    const auto found =
        std::ranges::find_if(bones_, [&](const AsfBone& bone) { return bone.name == name; });
    if (found == bones_.end()) cursor_.fail(fmt::format("no bone is called {}", shown(name)));
    return static_cast<int>(found - bones_.begin());
  }

  Eigen::Matrix3d turned(const std::vector<int>& order, const Eigen::Vector3d& angles) const {
    std::vector<double> degrees;
    for (const double angle : angles) degrees.push_back(angle * degrees_per_angle_);
    return turn_of(order, degrees);
  }

  /// Parents first, as the hierarchy has them.
  AsfSkeleton assembled() {
    std::vector<int> place(bones_.size(), -1);
    std::vector<int> waiting{0};
    while (!waiting.empty()) {
      const int bone = waiting.back();
      waiting.pop_back();
      place[static_cast<std::size_t>(bone)] = static_cast<int>(skeleton_.bones.size());
      AsfBone placed = bones_[static_cast<std::size_t>(bone)];
      placed.end_cm *= skeleton_.cm_per_unit;
      if (bone > 0) placed.parent = place[static_cast<std::size_t>(parents_.at(bone))];
      skeleton_.bones.push_back(std::move(placed));
      for (int child = static_cast<int>(bones_.size()) - 1; child > 0; --child)
        if (const auto at = parents_.find(child); at != parents_.end() && at->second == bone)
          waiting.push_back(child);
    }
    for (std::size_t bone = 0; bone < bones_.size(); ++bone)
      if (place[bone] < 0)
        cursor_.fail(
            fmt::format("{} hangs on nothing that hangs on the root; name it in :hierarchy",
                        shown(bones_[bone].name)));
    skeleton_.root_cm = position_ * skeleton_.cm_per_unit;
    return std::move(skeleton_);
  }

  Cursor cursor_;
  AsfSkeleton skeleton_;
  std::vector<AsfBone> bones_;  ///< in the file's order, in its units
  std::set<std::string> names_{"root"};
  std::map<int, int> parents_;  ///< by a bone's index there
  Eigen::Vector3d position_{0, 0, 0};
  double degrees_per_angle_ = 1;
};

}  // namespace

Eigen::Matrix3d turn_of(const std::vector<int>& order, const std::vector<double>& angles_deg) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (std::size_t i = 0; i < order.size(); ++i)
    turn = Eigen::AngleAxisd(angles_deg[i] * kRadiansPerDegree, Eigen::Vector3d::Unit(order[i])) *
           turn;
  return turn;
}

std::string without_comments(std::string_view text) {
  std::string result(text);
  bool comment = false;
  for (char& c : result) {
    comment = c != '\n' && (comment || c == '#');
    if (comment) c = ' ';
  }
  return result;
}

AsfSkeleton parse_asf(std::string_view text, const std::string& name) {
  const std::string plain = without_comments(text);
  return AsfParser(plain, name).parse();
}

}  // namespace mcdbn
