#include "formats/asf_amc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/numbers.hpp"
#include "formats/asf_skeleton.hpp"
#include "formats/bvh_parser.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

using bvh::Cursor, bvh::same_word;

/// The rate of CMU's captures; an AMC does not give its rate.
constexpr double kRate_hz = 120;

Skeleton skeleton_of(const AsfSkeleton& asf) {
  Skeleton skeleton;
  std::vector<bool> ends(asf.bones.size(), true);
  for (const AsfBone& bone : asf.bones) {
    Joint joint;
    joint.name = bone.name;
    joint.parent = bone.parent;
    if (bone.parent < 0)
      joint.channels = {Channel::x_position, Channel::y_position, Channel::z_position};
    else
      joint.offset = asf.bones[static_cast<std::size_t>(bone.parent)].end_cm;
    joint.channels.insert(joint.channels.end(),
                          {Channel::z_rotation, Channel::y_rotation, Channel::x_rotation});
    if (bone.parent >= 0) ends[static_cast<std::size_t>(bone.parent)] = false;
    skeleton.joints.push_back(std::move(joint));
  }
  for (std::size_t b = 0; b < ends.size(); ++b)
    if (ends[b]) skeleton.joints[b].end_sites.push_back(asf.bones[b].end_cm);
  return skeleton;
}

class AmcParser {
 public:
  AmcParser(std::string_view text, const std::string& name, const AsfSkeleton& asf)
      : cursor_(text, name, nullptr), asf_(asf), skeleton_(skeleton_of(asf)) {}

  Motion parse() {
    std::string_view word = cursor_.next();
    for (; !word.empty() && word.front() == ':'; word = cursor_.next())
      if (same_word(word, ":radians")) degrees_per_angle_ = 1 / kRadiansPerDegree;
    std::vector<RowVectorD> frames;
    while (!word.empty()) {
      check_frame_number(word);
      word = add_frame(frames);
    }
    if (frames.empty()) cursor_.fail("no frame; an AMC file holds a number and its bones' angles");
    Motion motion{skeleton_, 1.0 / kRate_hz,
                  MatrixD(static_cast<Eigen::Index>(frames.size()), skeleton_.channel_count())};
    for (std::size_t t = 0; t < frames.size(); ++t)
      motion.channels.row(static_cast<Eigen::Index>(t)) = frames[t];
    return motion;
  }

 private:
  void check_frame_number(std::string_view word) const {
    int number = 0;
    const auto end = word.data() + word.size();
    if (std::from_chars(word.data(), end, number).ptr != end)
      cursor_.fail(fmt::format("{} where the number of a frame is wanted", shown(word)));
  }

  /// @return the word after the frame: the next one's number
  std::string_view add_frame(std::vector<RowVectorD>& frames) {
    const int line = cursor_.line();
    RowVectorD channels = RowVectorD::Zero(skeleton_.channel_count());
    std::vector<bool> seen(asf_.bones.size(), false);
    std::string_view word = cursor_.next();
    for (; !word.empty() && !starts_number(word); word = cursor_.next()) {
      const int bone = skeleton_.find(word);
      if (bone < 0)
        cursor_.fail(fmt::format("the skeleton has no bone {}; is it another's ASF?", shown(word)));
      if (seen[static_cast<std::size_t>(bone)])
        cursor_.fail(fmt::format("{} comes twice in a frame", shown(word)));
      seen[static_cast<std::size_t>(bone)] = true;
      set_channels(bone, frames.empty() ? nullptr : frames.back().data(), channels);
    }
    for (std::size_t b = 0; b < seen.size(); ++b)
      if (!seen[b] && !asf_.bones[b].freedoms.empty())
        cursor_.fail_at(line, fmt::format("the frame has no line of {}", asf_.bones[b].name));
    frames.push_back(std::move(channels));
    return word;
  }

  static bool starts_number(std::string_view word) {
    return word.front() >= '0' && word.front() <= '9';
  }

  void set_channels(int index, const double* before, RowVectorD& channels) {
    const AsfBone& bone = asf_.bones[static_cast<std::size_t>(index)];
    const Joint& joint = skeleton_.joints[static_cast<std::size_t>(index)];
    const int first = skeleton_.first_channel(index);
    std::vector<int> axes;
    std::vector<double> angles_deg;
    Eigen::Vector3d moved_cm = asf_.root_cm;
    for (const int freedom : bone.freedoms) {
      if (cursor_.at_line_end())
        cursor_.fail(fmt::format("{} has fewer numbers than freedoms ({})", bone.name,
                                 bone.freedoms.size()));
      const double value = cursor_.number("a bone's angle");
      if (freedom > 2) {
        moved_cm[freedom - 3] += value * asf_.cm_per_unit;
      } else {
        axes.push_back(freedom);
        angles_deg.push_back(value * degrees_per_angle_);
      }
    }
    if (!cursor_.at_line_end())
      cursor_.fail(
          fmt::format("{} has more numbers than freedoms ({})", bone.name, bone.freedoms.size()));
    if (index == 0) channels.head<3>() = moved_cm.transpose();
    set_local_rotation(joint, bone.axes * turn_of(axes, angles_deg) * bone.axes.transpose(),
                       before ? before + first : nullptr, channels.data() + first);
  }

  Cursor cursor_;
  const AsfSkeleton& asf_;
  Skeleton skeleton_;
  double degrees_per_angle_ = 1;
};

}  // namespace

Skeleton parse_asf_skeleton(std::string_view asf, const std::string& name) {
  return skeleton_of(parse_asf(asf, name));
}

Motion parse_asf_amc(std::string_view asf, const std::string& asf_name, std::string_view amc,
                     const std::string& amc_name, std::vector<std::string>* warnings) {
  const AsfSkeleton skeleton = parse_asf(asf, asf_name);
  const std::string plain = without_comments(amc);
  Motion motion = AmcParser(plain, amc_name, skeleton).parse();
  if (warnings)
    warnings->push_back(
        fmt::format("{}: on the skeleton {}, in centimetres, at {:g} Hz: an AMC "
                    "does not give its rate",
                    amc_name, asf_name, kRate_hz));
  return motion;
}

}  // namespace mcdbn
