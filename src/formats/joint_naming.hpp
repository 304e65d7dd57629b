#pragma once

#include <span>
#include <string>
#include <vector>

#include "formats/json_text.hpp"
#include "formats/seen_people.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

/// The content holds no person, and its joints are known only from people.
class NoPersonSeen : public InputError {
 public:
  explicit NoPersonSeen(const std::string& file)
      : InputError(file + ": no person in any frame, so its joints are not known") {}
};

/// Whether a body has so many joints in one of the known joint sets, with or without face and
/// hands.
bool is_joint_count(std::size_t joints);

/// Names the joints. Where the file gives as many names as joints, those; else the joint
/// set of that count, of several the usual one, with all of them as SeenPeople::possible_sets
/// (BODY_25 and BODY_25B have the same count). Faces and hands behind a body's joints (133 to
/// 136) are left out, with a notice, also where the file names them. Other counts become joint_0,
/// joint_1 … without roles, with a notice.
/// @throws InputError if the counts differ or are above kMostJoints; NoPersonSeen
void name_joints_by_count(SeenPeople& people, const std::string& file,
                          const std::vector<std::string>& names = {});

/// Whether the columns are a detector's, not a skeleton's: most are called as in one of the joint
/// sets.
bool are_a_detectors(const std::vector<std::string>& names);

/// Names, in the file's order. A skeleton's joints are no keypoints: as in Track2d.
void name_joints(SeenPeople& people, std::vector<std::string> names);

/// One body of a JSON list of numbers, x, y, confidence of each joint; of lists of 2 or 3 numbers;
/// of an object with the lists x, y and, where there, visible; with confidences beside them.
/// @throws InputError
SeenPerson person_in_json(const JsonPlace& keypoints);
SeenPerson person_in_json(const JsonPlace& keypoints, const JsonPlace& scores);

}  // namespace mcdbn
