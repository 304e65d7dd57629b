#include "comparison/report_clips.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "motion/body_size.hpp"

namespace mcdbn {
namespace {

/// Which joints of a clip's skeleton a report shows, and what hangs below them. An answer may stand
/// on another skeleton, with its joints in another order: they are found there by name.
class Figure {
 public:
  /// @param names of the joints, the root first; the same for every clip of a model
  Figure(const ClipResult& result, const std::vector<std::string>& names)
      : skeleton_(result.truth.motion.skeleton), names_(names) {
    for (const std::string& name : names) joints_.push_back(skeleton_.find(name));
    for (const int joint : joints_) parents_.push_back(shown_ancestor(joint));
    for (int joint = 0; joint < skeleton_.joint_count(); ++joint) {
      const Joint& ending = skeleton_.joints[static_cast<std::size_t>(joint)];
      if (!every_answer_has(result, ending.name)) continue;
      for (const Eigen::Vector3d& end : ending.end_sites) add_end(joint, end);
    }
  }

  const std::vector<std::string>& names() const { return names_; }
  const std::vector<int>& parents() const { return parents_; }
  int joint_count() const { return static_cast<int>(joints_.size()); }

  /// @param motion the truth, or an answer  @return [frames x 3·points], mm on a 1.7 m body
  MatrixD points_mm(const Motion& motion) const {
    const double mm = 1000.0 / file_units_per_metre(motion.skeleton);
    const auto index_in = [&](const std::string& name) {
      return static_cast<std::size_t>(motion.skeleton.find(name));
    };
    std::vector<std::size_t> joints, ending;
    for (int i = 0; i < joint_count(); ++i)
      joints.push_back(index_in(names_[static_cast<std::size_t>(i)]));
    for (const End& end : ends_) ending.push_back(index_in(end.joint));
    MatrixD points(motion.frames(), 3 * static_cast<Eigen::Index>(names_.size()));
    for (int frame = 0; frame < motion.frames(); ++frame) {
      const WorldPose pose = forward_kinematics(motion.skeleton, motion.channels.row(frame));
      Eigen::Index column = 0;
      const auto put = [&](const Eigen::Vector3d& point_mm) {
        points.block<1, 3>(frame, column) = point_mm.transpose();
        column += 3;
      };
      for (const std::size_t joint : joints) put(mm * pose.position[joint]);
      for (std::size_t i = 0; i < ends_.size(); ++i)
        put(mm * pose.position[ending[i]] + pose.world_from_joint[ending[i]] * ends_[i].offset_mm);
    }
    return points;
  }

 private:
  struct End {
    std::string joint;
    Eigen::Vector3d offset_mm;  ///< from the joint, along its own axes
  };

  static bool every_answer_has(const ClipResult& result, const std::string& joint) {
    const auto has = [&](const ScoredAnswer& answer) {
      return answer.motion.skeleton.find(joint) >= 0;
    };
    return std::ranges::all_of(result.samples, has) &&
           std::ranges::all_of(result.other_answers,
                               [&](const auto& other) { return has(other.second); });
  }

  int index_of(int joint) const {
    const auto found = std::find(joints_.begin(), joints_.end(), joint);
    return found == joints_.end() ? -1 : static_cast<int>(found - joints_.begin());
  }
  int shown_ancestor(int joint) const {
    do joint = skeleton_.joints[static_cast<std::size_t>(joint)].parent;
    while (joint >= 0 && index_of(joint) < 0);
    return joint < 0 ? -1 : index_of(joint);
  }
  void add_end(int joint, const Eigen::Vector3d& offset) {
    const int parent = index_of(joint) >= 0 ? index_of(joint) : shown_ancestor(joint);
    if (parent < 0 || offset.norm() == 0) return;
    const std::string& name = skeleton_.joints[static_cast<std::size_t>(joint)].name;
    ends_.push_back({name, offset * (1000.0 / file_units_per_metre(skeleton_))});
    names_.push_back(name + " end");
    parents_.push_back(parent);
  }

  const Skeleton& skeleton_;  ///< the truth's
  std::vector<int> joints_;
  std::vector<End> ends_;
  std::vector<std::string> names_;
  std::vector<int> parents_;
};

ReportMotion report_motion(const Figure& figure, const ScoredAnswer& answer) {
  ReportMotion motion{figure.points_mm(answer.motion), answer.score};
  if (answer.deviation_mm.size() == 0) return motion;
  const int joints = figure.joint_count();
  motion.deviation_mm = MatrixD::Zero(answer.motion.frames(), 3 * joints);
  for (int joint = 1; joint < joints; ++joint) {
    const auto& name = figure.names()[static_cast<std::size_t>(joint)];
    motion.deviation_mm.middleCols(3 * joint, 3) =
        answer.deviation_mm.middleCols(3 * answer.motion.skeleton.find(name), 3);
  }
  return motion;
}

/// NaN where the track does not show the joint.
MatrixD track_px(const Track2d& track, const std::vector<std::string>& names) {
  MatrixD pixels =
      MatrixD::Constant(track.frames(), 2 * static_cast<Eigen::Index>(names.size()), NAN);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int joint = track.find(names[i]);
    if (joint < 0) continue;
    pixels.col(2 * static_cast<Eigen::Index>(i)) = track.x_px.col(joint);
    pixels.col(2 * static_cast<Eigen::Index>(i) + 1) = track.y_px.col(joint);
  }
  return pixels;
}

/// Its file's name, with the folder's before it where another clip has the same.
std::string unique_name(const std::filesystem::path& file, std::set<std::string>& taken) {
  std::string name = file.stem().string();
  for (std::filesystem::path folder = std::filesystem::weakly_canonical(file).parent_path();
       !taken.insert(name).second; folder = folder.parent_path()) {
    if (folder.has_filename())
      name.insert(0, folder.filename().string() + "/");
    else
      name += "'";
  }
  return name;
}

}  // namespace

std::vector<ReportClip> report_clips(const Model& model, const std::vector<ClipResult>& results,
                                     bool by_folder) {
  std::vector<std::string> names = {model.modalities.root_name()};
  const auto& tracked = model.modalities.track_features.joint_names();
  names.insert(names.end(), tracked.begin(), tracked.end());
  std::set<std::string> taken;
  std::vector<ReportClip> clips;
  for (const ClipResult& result : results) {
    const Figure figure(result, names);
    ReportClip clip;
    clip.name = unique_name(result.truth.file, taken);
    clip.action =
        by_folder
            ? std::filesystem::weakly_canonical(result.truth.file).parent_path().filename().string()
            : "all clips";
    clip.trained_on = result.trained_on;
    clip.known_person = result.known_person;
    clip.fps = result.truth.motion.fps();
    clip.point_names = figure.names();
    clip.parents = figure.parents();
    clip.joints = figure.joint_count();
    clip.truth_mm = figure.points_mm(result.truth.motion);
    clip.track_px = track_px(result.seen.joints, names);
    clip.width_px = result.truth.track.width_px;
    clip.height_px = result.truth.track.height_px;
    for (const ScoredAnswer& sample : result.samples)
      clip.samples.push_back(report_motion(figure, sample));
    for (const auto& [name, other] : result.other_answers)
      clip.others[name] = report_motion(figure, other);
    clip.track = result.track;
    clips.push_back(std::move(clip));
  }
  return clips;
}

}  // namespace mcdbn
