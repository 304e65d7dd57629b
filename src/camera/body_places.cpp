#include "camera/body_places.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>
#include <vector>

namespace mcdbn {
namespace {

/// A place in the middle of the body or on its left; the right is its mirror image.
struct Place {
  std::string_view name;  ///< without its side
  bool sided;
  std::optional<JointRole> role;
  double left, up, forward;  ///< from the joint's centre, shares of body height
  std::optional<std::pair<JointRole, JointRole>> halfway = std::nullopt;  ///< between these joints
};

constexpr std::pair kHips{JointRole::left_hip, JointRole::right_hip},
    kShoulders{JointRole::left_shoulder, JointRole::right_shoulder},
    kTrunk{JointRole::pelvis, JointRole::neck};

// Heights of body parts as shares of stature: Drillis and Contini (1966), as in Winter,
// Biomechanics and Motor Control of Human Movement, fig. 4.1: eye 0.936, chin 0.870, shoulder
// 0.818, ankle 0.039, foot length 0.152. Of the head: NASA-STD-3000, vol. 1, sec. 3 (men, 50th
// percentile, over a stature of 1.80 m): bitragion breadth 0.14 m, head length 0.20 m, tragion 0.13
// m below the top, interpupillary breadth 0.063 m. The head turns about the atlanto-occipital
// joint, some 2.5 cm below the tragion and 1 cm behind it (McConville et al. 1980), at 0.91 of
// stature. What detectors call shoulder, elbow, wrist, hip, knee and ankle is annotated as the
// joint itself: offset 0. Hips of trained detectors differ from the centre of the joint by 2 to 5
// cm in ways that hang on detector and view (Needham et al. 2021, doi 10.1038/s41598-021-00212-x):
// none is put in.
constexpr std::array kPlaces{
    Place{"head_top", false, JointRole::head, 0, 0.090, 0},
    Place{"forehead", false, JointRole::head, 0, 0.050, 0.058},
    Place{"nose", false, JointRole::head, 0, -0.002, 0.075},
    Place{"chin", false, JointRole::head, 0, -0.040, 0.058},
    Place{"eye", true, JointRole::head, 0.018, 0.026, 0.052},
    Place{"eye_inner", true, JointRole::head, 0.009, 0.026, 0.053},
    Place{"eye_outer", true, JointRole::head, 0.026, 0.026, 0.047},
    Place{"ear", true, JointRole::head, 0.039, 0.014, 0.006},
    Place{"mouth", true, JointRole::head, 0.014, -0.022, 0.064},
    Place{"head", false, JointRole::head, 0, 0.030, 0.010},
    // MPII's upper neck, where the head begins, just above the base of the neck.
    Place{"upper_neck", false, JointRole::head, 0, -0.040, 0},
    // Halpe's neck, annotated between the collar bones.
    Place{"neck", false, JointRole::neck, 0, -0.020, 0},
    // OpenPose's neck: computed from the shoulders.
    Place{"mid_shoulder", false, JointRole::neck, 0, -0.030, 0, kShoulders},
    Place{"thorax", false, JointRole::neck, 0, -0.030, 0, kShoulders},
    // Human3.6M's, halfway up the trunk: which joint is there differs between skeletons.
    Place{"spine", false, std::nullopt, 0, 0, 0, kTrunk},
    Place{"mid_hip", false, JointRole::pelvis, 0, 0, 0, kHips},
    Place{"shoulder", true, JointRole::left_shoulder, 0, 0, 0},
    Place{"elbow", true, JointRole::left_elbow, 0, 0, 0},
    Place{"wrist", true, JointRole::left_wrist, 0, 0, 0},
    Place{"hand", true, JointRole::left_hand, 0, 0, 0},
    Place{"index", true, JointRole::left_hand, 0, 0, 0},  // the knuckle
    Place{"pinky", true, JointRole::left_hand, 0, 0, 0},
    Place{"thumb", true, std::nullopt, 0, 0, 0},  // where it is hangs on how the hand is held
    Place{"hip", true, JointRole::left_hip, 0, 0, 0},
    Place{"knee", true, JointRole::left_knee, 0, 0, 0},
    Place{"ankle", true, JointRole::left_ankle, 0, 0, 0},
    // The ankle stands a quarter of the foot's length before the heel; the toe joint at 0.73 of it.
    Place{"heel", true, JointRole::left_ankle, 0, -0.028, -0.038},
    Place{"toe", true, JointRole::left_toe, 0, 0, 0},
    Place{"foot", true, JointRole::left_toe, 0, 0, 0},  // where another place is the ankle's
    Place{"big_toe", true, JointRole::left_toe, -0.012, -0.005, 0.035},
    Place{"small_toe", true, JointRole::left_toe, 0.020, -0.005, 0.015},
    Place{"foot_index", true, JointRole::left_toe, -0.008, -0.005, 0.035},
};

// Other words for them, in lower case, without sides and separators.
struct Synonym {
  std::string_view word, name;
};
constexpr std::array kSynonyms{
    Synonym{"headtop", "head_top"},
    Synonym{"tophead", "head_top"},
    Synonym{"topofhead", "head_top"},
    Synonym{"vertex", "head_top"},
    Synonym{"bigtoe", "big_toe"},
    Synonym{"smalltoe", "small_toe"},
    Synonym{"littletoe", "small_toe"},
    Synonym{"footindex", "foot_index"},
    Synonym{"eyeinner", "eye_inner"},
    Synonym{"innereye", "eye_inner"},
    Synonym{"eyeouter", "eye_outer"},
    Synonym{"outereye", "eye_outer"},
    Synonym{"midhip", "mid_hip"},
    Synonym{"hipcenter", "mid_hip"},
    Synonym{"hipcentre", "mid_hip"},
    Synonym{"pelvis", "mid_hip"},
    Synonym{"root", "mid_hip"},
    Synonym{"midshoulder", "mid_shoulder"},
    Synonym{"upperneck", "upper_neck"},
    Synonym{"neckbase", "neck"},
    Synonym{"indexfinger", "index"},
    Synonym{"indexknuckle", "index"},
    Synonym{"pinkyfinger", "pinky"},
    Synonym{"littlefinger", "pinky"},
    Synonym{"toes", "toe"},
    Synonym{"toebase", "toe"},
};

const Place* find_place(std::string_view name) {
  const auto* found = std::ranges::find(kPlaces, name, &Place::name);
  return found == kPlaces.end() ? nullptr : found;
}

/// The place of a word in lower case without separators.
const Place* place_of_word(std::string_view word) {
  if (const Place* place = find_place(word)) return place;
  const auto* found = std::ranges::find(kSynonyms, word, &Synonym::word);
  return found == kSynonyms.end() ? nullptr : find_place(found->name);
}

/// "LShoulder" to l, shoulder; "left_eye_inner" to left, eye, inner; all in lower case.
std::vector<std::string> words_of(std::string_view spelling) {
  std::vector<std::string> words;
  bool new_word = true;
  for (std::size_t i = 0; i < spelling.size(); ++i) {
    const auto letter = static_cast<unsigned char>(spelling[i]);
    if (std::isalnum(letter) == 0) {
      new_word = true;
      continue;
    }
    const auto is_upper = [&](std::size_t k) {
      return std::isupper(static_cast<unsigned char>(spelling[k])) != 0;
    };
    const auto is_lower = [&](std::size_t k) {
      return k < spelling.size() && std::islower(static_cast<unsigned char>(spelling[k])) != 0;
    };
    // A capital begins a word behind a small letter, and before one: LShoulder.
    if (is_upper(i) && i > 0 && (!is_upper(i - 1) || is_lower(i + 1))) new_word = true;
    if (new_word) words.emplace_back();
    new_word = false;
    words.back() += static_cast<char>(std::tolower(letter));
  }
  return words;
}

enum class Side { middle, left, right };

std::optional<Side> side_of(std::string_view word) {
  if (word == "l" || word == "left") return Side::left;
  if (word == "r" || word == "right") return Side::right;
  return {};
}

std::string plain_name(const Place& place, Side side) {
  if (side == Side::middle) return std::string(place.name);
  return (side == Side::left ? "left_" : "right_") + std::string(place.name);
}

}  // namespace

std::optional<Keypoint> body_place(std::string_view name) {
  const bool left = name.starts_with("left_"), right = name.starts_with("right_");
  if (left || right) name.remove_prefix(name.find('_') + 1);
  const Place* place = find_place(name);
  if (place == nullptr || place->sided != (left || right)) return {};
  Keypoint keypoint;
  keypoint.name = plain_name(*place, left ? Side::left : right ? Side::right : Side::middle);
  keypoint.role = place->role;
  keypoint.offset = {place->left, place->up, place->forward};
  keypoint.halfway = place->halfway;
  if (right) {
    keypoint.offset.x() = -keypoint.offset.x();
    if (place->role) keypoint.role = other_side(*place->role);
  }
  return keypoint;
}

std::string place_name_of(std::string_view spelling) {
  Side side = Side::middle;
  std::string rest;
  for (const std::string& word : words_of(spelling)) {
    const std::optional<Side> named = side_of(word);
    if (named && side != Side::middle) return {};
    if (named)
      side = *named;
    else if (word != "pose" && word != "landmark" && word != "keypoint" && word != "joint")
      rest += word;  // PoseLandmark.NOSE is a nose
  }
  const Place* place = place_of_word(rest);
  // Run together: "lshoulder", "leftshoulder".
  for (const auto& [prefix, prefix_side] : {std::pair{std::string_view("left"), Side::left},
                                            {std::string_view("right"), Side::right},
                                            {std::string_view("l"), Side::left},
                                            {std::string_view("r"), Side::right}}) {
    if (place != nullptr || side != Side::middle || !rest.starts_with(prefix)) continue;
    const Place* sided = place_of_word(std::string_view(rest).substr(prefix.size()));
    if (sided == nullptr || !sided->sided) continue;
    place = sided;
    side = prefix_side;
  }
  if (place == nullptr) return {};
  // The middle of a pair: "hip" alone is the middle of the hips.
  if (place->sided && side == Side::middle) return place->name == "hip" ? "mid_hip" : "";
  if (!place->sided && side != Side::middle) return {};
  return plain_name(*place, side);
}

}  // namespace mcdbn
