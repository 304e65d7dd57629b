// JSON of landmarks: of each frame a list of {x, y, z, visibility} or of [x, y, z]; an object that
// holds such a list; an object of named landmarks; a list of such bodies. So MediaPipe's and
// TensorFlow.js' results are saved.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/numbers.hpp"
#include "formats/csv_text.hpp"
#include "formats/field_names.hpp"
#include "formats/frame_numbers.hpp"
#include "formats/frame_times.hpp"
#include "formats/landmarks.hpp"
#include "formats/rate_and_size.hpp"

namespace mcdbn {
namespace {

constexpr std::array kBodyKeys{"landmarks", "pose_landmarks", "poseLandmarks", "landmark",
                               "keypoints", "joints",         "pose",          "poses",
                               "bodies",    "people",         "persons",       "detections"};
constexpr int kDepth = 6;  // lists in lists down to a body
constexpr std::array kWorldKeys{"pose_world_landmarks", "poseWorldLandmarks", "world_landmarks",
                                "worldLandmarks"};
constexpr std::array kScoresKeys{"keypoint_scores", "scores"};  // of all landmarks of a body
constexpr std::array kNameKeys{"name", "part"};
constexpr std::array kPersonKeys{"track_id", "trackId", "person_id", "personId"};

/// The value of the first of these keys under which an object has one: MediaPipe's landmarks have
/// null for what is not known of them.
template <typename Keys>
std::optional<JsonPlace> any_of_keys(const JsonPlace& place, const Keys& keys) {
  for (const char* key : keys)
    if (place.has(key) && !place[key].value().is_null()) return place[key];
  return {};
}

bool is_landmark(const JsonPlace& place) {
  if (place.is_object()) return (place.has("x") && place.has("y")) || place.has("position");
  if (!place.is_list() || place.size() < 2 || place.size() > 5) return false;
  return std::ranges::all_of(
      place.value(), [](const auto& value) { return value.is_number() || value.is_null(); });
}

/// A list of landmarks, or an object of nothing else.
bool is_body(const JsonPlace& place) {
  if (place.size() < 5) return false;
  if (place.is_list()) return is_landmark(place.at(0));
  return place.is_object() && std::ranges::all_of(place.keys(), [&](const std::string& key) {
           return is_landmark(place[key]);
         });
}

/// Keys with a number each ("0" to "32", "landmark_0") in the order of these, not of their letters.
std::vector<std::string> keys_by_number(std::vector<std::string> keys) {
  const auto numbers = frame_numbers(keys);
  std::map<long long, std::string> ordered;
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (numbers[i]) ordered.emplace(*numbers[i], keys[i]);
  if (ordered.size() < keys.size()) return keys;
  keys.clear();
  for (auto& [number, key] : ordered) keys.push_back(std::move(key));
  return keys;
}

/// The number of the person whom an object shows. @param of_frame an `id` is a frame's own
std::optional<long long> person_number(const JsonPlace& place, bool of_frame) {
  auto id = any_of_keys(place, kPersonKeys);
  if (!id && !of_frame) id = any_of_keys(place, std::array{"id"});
  if (!id || !id->value().is_number() || id->number() != std::floor(id->number())) return {};
  return id->whole_number();
}

/// Whether a list has a number for each landmark of a body, or of each of a list of bodies.
bool are_confidences_of(const JsonPlace& list, const JsonPlace& bodies) {
  if (!list.is_list() || list.size() != bodies.size()) return false;
  if (is_body(bodies)) return list.at(0).value().is_number() || list.at(0).value().is_null();
  for (std::size_t i = 0; bodies.is_list() && i < bodies.size(); ++i)
    if (bodies.at(i).size() > 0) return are_confidences_of(list.at(i), bodies.at(i));
  return false;
}

/// The confidences of bodies that stand beside them, nested as they are.
std::optional<JsonPlace> confidences_beside(const JsonPlace& place, const JsonPlace& bodies) {
  for (const std::string& key : place.keys())
    if (is_confidence_list_name(key) && are_confidences_of(place[key], bodies)) return place[key];
  // Scores of another count are the file's fault; other lists may be of something else.
  return any_of_keys(place, kScoresKeys);
}

struct LandmarkBody {
  SeenPerson person;
  /// [landmarks] The number behind x and y, a confidence or a depth, 1 where it is null; -1: no
  /// list of three.
  std::vector<double> thirds;
};

class LandmarkReader {
 public:
  explicit LandmarkReader(std::string file) : file_(std::move(file)) {}

  SeenPeople read(const JsonPlace& content) {
    take_rate_and_size(content, people_);
    add_all(content);
    take_bodies();
    name_landmarks(people_, file_, names_);
    return std::move(people_);
  }

 private:
  void add_all(const JsonPlace& content) {
    if (content.is_object() && content.has("frames")) return add_list_or_keys(content["frames"]);
    add_list_or_keys(content);
  }

  void add_list_or_keys(const JsonPlace& content) {
    if (is_body(content)) return add_frame(content, 0);
    if (content.is_list()) {
      const std::vector<long long> numbers = numbers_of_frames(content, people_);
      for (std::size_t i = 0; i < numbers.size(); ++i) add_frame(content.at(i), numbers[i]);
      return;
    }
    if (any_of_keys(content, kBodyKeys) || any_of_keys(content, kWorldKeys))
      return add_frame(content, 0);
    const std::vector<std::string> keys = content.keys();
    const auto numbers = numbers_of_keys(keys);
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (numbers[i]) add_frame(content[keys[i]], *numbers[i]);
  }

  /// The frames whose numbers or times the keys are.
  /// @return [keys]; none where a key is of no frame
  std::vector<std::optional<long long>> numbers_of_keys(const std::vector<std::string>& keys) {
    auto numbers = frame_numbers(keys);
    if (!are_times(keys)) return numbers;
    std::vector<double> times(keys.size(), kNan);  // in their order, as the numbers are
    std::size_t count = 0;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (!numbers[i]) continue;
      times[static_cast<std::size_t>(*numbers[i])] = number(keys[i]).value_or(kNan);
      ++count;
    }
    times.resize(count);
    const std::vector<long long> frames = frames_by_times(times);
    if (frames.empty()) {
      people_.notices.emplace_back(
          "its frames are named by time: they are taken one after the other");
      return numbers;
    }
    take_times(people_, "time", frames, times);
    for (auto& place : numbers)
      if (place) place = frames[static_cast<std::size_t>(*place)];
    return numbers;
  }

  void add_frame(const JsonPlace& frame, long long number) {
    const auto [at, is_new] = bodies_.try_emplace(number);
    if (!is_new) frame.fail(fmt::format("a second frame {}", number));
    add_bodies(frame, at->second);
  }

  /// A body, or a list of them, or an object around either. Nothing: no person was found.
  /// @param scores confidences beside them, nested as they are
  void add_bodies(const JsonPlace& place, std::vector<LandmarkBody>& bodies, int depth = 0,
                  std::optional<JsonPlace> scores = {}) {
    if (scores && !scores->is_list()) scores.reset();  // of a body as a whole
    if (depth > kDepth) place.fail("no landmarks down to here");
    if (place.value().is_null() || place.size() == 0) return;
    if (is_body(place)) {
      bodies.push_back(body_of(place));
      if (scores) take_scores(bodies.back(), *scores);
    } else if (place.is_list()) {
      for (std::size_t i = 0; i < place.size(); ++i)
        add_bodies(place.at(i), bodies, depth + 1,
                   scores ? std::optional(scores->at(i)) : std::nullopt);
    } else if (place.is_object()) {
      if (place.has("channels") && place.has("joints"))
        place.fail("points in space, as regenerate --follow writes them, not a 2D track");
      const auto inside = any_of_keys(place, kBodyKeys);
      const std::size_t before = bodies.size();
      if (inside)
        add_bodies(*inside, bodies, depth + 1, confidences_beside(place, *inside));
      else if (const auto world = any_of_keys(place, kWorldKeys); world && world->size() > 0)
        world->fail(
            "points in space (world landmarks, metres), not places in an image: save the image's "
            "landmarks, 'landmarks' or 'pose_landmarks'");
      if (const auto person = person_number(place, depth == 0);
          person && bodies.size() == before + 1)
        bodies.back().person.id = person;
    } else {
      place.fail("neither landmarks nor a list of them");
    }
  }

  LandmarkBody body_of(const JsonPlace& place) {
    if (place.is_list() && place.at(0).is_list()) people_.axes_are_unnamed = true;
    LandmarkBody body;
    std::vector<std::string> names;
    if (place.is_list()) {
      for (const JsonPlace& landmark : place.list()) {
        add_landmark(landmark, body);
        if (const auto name = any_of_keys(landmark, kNameKeys); name && name->value().is_string())
          names.push_back(name->text());
      }
    } else {
      names = keys_by_number(place.keys());
      for (const std::string& key : names) add_landmark(place[key], body);
    }
    if (names.size() == body.person.x_px.size()) {
      if (names_.empty()) names_ = names;
      if (names != names_) place.fail("other landmarks than in the bodies before it");
    }
    return body;
  }

  static void take_scores(LandmarkBody& body, const JsonPlace& scores) {
    std::vector<double> confidence = scores.numbers();
    if (confidence.size() != body.person.x_px.size())
      scores.fail(
          fmt::format("{} scores of {} joints", confidence.size(), body.person.x_px.size()));
    body.person.confidence = std::move(confidence);
    body.thirds.assign(body.thirds.size(), -1);
  }

  /// The confidence of a landmark of which it is not known.
  static double one_if_null(double confidence) { return std::isnan(confidence) ? 1.0 : confidence; }

  /// `visible` may be true or false.
  static double confidence_of(const JsonPlace& place) {
    return place.value().is_boolean() ? (place.truth() ? 1.0 : 0.0) : place.number();
  }

  static void add_landmark(const JsonPlace& place, LandmarkBody& body) {
    SeenPerson& person = body.person;
    if (place.is_list()) {
      const std::vector<double> numbers = place.numbers();
      if (numbers.size() < 2) place.fail("x and y are needed");
      person.x_px.push_back(numbers[0]);
      person.y_px.push_back(numbers[1]);
      person.confidence.push_back(numbers.size() > 3 ? one_if_null(numbers[3]) : 1.0);
      body.thirds.push_back(numbers.size() == 3 ? one_if_null(numbers[2]) : -1);
      return;
    }
    const JsonPlace at = place.has("position") ? place["position"] : place;
    person.x_px.push_back(at["x"].number());
    person.y_px.push_back(at["y"].number());
    const auto confidence = any_of_keys(place, kConfidenceNames);
    person.confidence.push_back(confidence ? confidence_of(*confidence) : 1.0);
    body.thirds.push_back(-1);
  }

  /// Whether the third number of [x, y, number] is a confidence: it is never below 0 in the file.
  /// Else it is a depth.
  bool thirds_are_confidences() const {
    for (const auto& [number, frame] : bodies_)
      for (const LandmarkBody& body : frame)
        for (const double third : body.thirds)
          if (third < 0) return false;
    return true;
  }

  void take_bodies() {
    const bool confidences = thirds_are_confidences();
    for (auto& [number, frame] : bodies_) {
      auto& people = people_.frames[number];
      for (LandmarkBody& body : frame) {
        if (confidences) body.person.confidence = std::move(body.thirds);
        mark_missing(body.person);
        people.push_back(std::move(body.person));
      }
    }
  }

  std::string file_;
  std::vector<std::string> names_;
  std::map<long long, std::vector<LandmarkBody>> bodies_;  ///< by the numbers of frames
  SeenPeople people_;
};

/// Whether a body lies in the first places inside.
bool holds_body(const JsonPlace& place, int depth = 0) {
  if (is_body(place)) return true;
  if (depth > kDepth || place.size() == 0) return false;
  if (place.is_list()) {
    // The first frames may be without a person.
    for (std::size_t i = 0; i < std::min<std::size_t>(place.size(), 1000); ++i)
      if (holds_body(place.at(i), depth + 1)) return true;
    return false;
  }
  if (!place.is_object()) return false;
  if (place.has("frames")) return holds_body(place["frames"], depth + 1);
  if (const auto inside = any_of_keys(place, kBodyKeys)) return holds_body(*inside, depth + 1);
  if (const auto world = any_of_keys(place, kWorldKeys)) return holds_body(*world, depth + 1);
  return depth == 0 && std::ranges::any_of(place.keys(), [&](const std::string& key) {
           return frame_numbers({key}).front() && holds_body(place[key], depth + 1);
         });
}

}  // namespace

bool are_landmarks(const JsonPlace& content) {
  return holds_body(content);
}

SeenPeople read_landmarks(const JsonPlace& content, const std::string& file) {
  return LandmarkReader(file).read(content);
}

}  // namespace mcdbn
