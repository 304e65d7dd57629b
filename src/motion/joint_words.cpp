#include "motion/joint_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace mcdbn {
namespace {

struct WordSpelling {
  std::string_view spelling;
  JointWord word;
};

using enum JointWord;

/// Joints in the middle, as their names read without anything but letters.
constexpr std::array kMiddle{
    WordSpelling{"hips", hips},      WordSpelling{"hip", hips},
    WordSpelling{"pelvis", hips},    WordSpelling{"midhip", hips},
    WordSpelling{"neck", neck},      WordSpelling{"lowerneck", neck},
    WordSpelling{"neckbase", neck},  WordSpelling{"upperneck", neck},
    WordSpelling{"necklower", neck}, WordSpelling{"neckupper", neck},
    WordSpelling{"necktwist", neck}, WordSpelling{"head", head},
    WordSpelling{"skull", head},
};

/// Joints of the sides, likewise, without the side.
constexpr std::array kSided{
    WordSpelling{"clavicle", clavicle},
    WordSpelling{"collar", clavicle},
    WordSpelling{"collarbone", clavicle},
    WordSpelling{"scapula", clavicle},
    WordSpelling{"shoulder", shoulder},
    WordSpelling{"upperarm", upper_arm},
    WordSpelling{"uparm", upper_arm},
    WordSpelling{"uarm", upper_arm},
    WordSpelling{"humerus", upper_arm},
    WordSpelling{"shldr", upper_arm},
    WordSpelling{"shldrbend", upper_arm},
    WordSpelling{"arm", arm},
    WordSpelling{"armstretch", arm},
    WordSpelling{"forearm", forearm},
    WordSpelling{"forearmbend", forearm},
    WordSpelling{"forearmstretch", forearm},
    WordSpelling{"lowerarm", forearm},
    WordSpelling{"lowarm", forearm},
    WordSpelling{"farm", forearm},
    WordSpelling{"elbow", forearm},
    WordSpelling{"radius", forearm},
    WordSpelling{"wrist", wrist},
    WordSpelling{"hand", hand},
    WordSpelling{"fingers", fingers},
    WordSpelling{"fingerbase", fingers},
    WordSpelling{"handindex", fingers},
    WordSpelling{"handmiddle", fingers},
    WordSpelling{"handend", fingers},
    WordSpelling{"index", fingers},
    WordSpelling{"middle", fingers},
    WordSpelling{"hip", hip},
    WordSpelling{"thigh", thigh},
    WordSpelling{"thighbend", thigh},
    WordSpelling{"thighstretch", thigh},
    WordSpelling{"upleg", thigh},
    WordSpelling{"upperleg", thigh},
    WordSpelling{"femur", thigh},
    WordSpelling{"leg", leg},
    WordSpelling{"legstretch", leg},
    WordSpelling{"shin", shin},
    WordSpelling{"calf", shin},
    WordSpelling{"shank", shin},
    WordSpelling{"lowerleg", shin},
    WordSpelling{"lowleg", shin},
    WordSpelling{"knee", shin},
    WordSpelling{"tibia", shin},
    WordSpelling{"ankle", ankle},
    WordSpelling{"foot", foot},
    WordSpelling{"toe", toe},
    WordSpelling{"toes", toe},
    WordSpelling{"toebase", toe},
    WordSpelling{"ball", toe},
};

/// Words that programs put before the names of joints, also where others stand beside them.
constexpr std::array<std::string_view, 5> kProgramWords{"j", "bip", "def", "mixamorig",
                                                        "valvebiped"};

/// Letters that mark the middle, where l and r mark the sides: VRM's, Maya's, Auto-Rig Pro's.
constexpr std::string_view kMiddleMarks = "cmx";

template <std::size_t count>
std::optional<JointWord> look_up(const std::array<WordSpelling, count>& words,
                                 std::string_view spelling) {
  const auto found = std::ranges::find(words, spelling, &WordSpelling::spelling);
  if (found == words.end()) return {};
  return found->word;
}

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

/// Lower case; everything but letters and digits becomes a blank; digits at the end go.
std::string simplified(std::string_view name) {
  std::string text;
  for (const char c : name)
    text += std::isalnum(static_cast<unsigned char>(c)) != 0
                ? static_cast<char>(std::tolower(static_cast<unsigned char>(c)))
                : ' ';
  while (!text.empty() && !is_letter(text.back())) text.pop_back();
  return text;
}

std::string letters_of(std::string_view text) {
  std::string letters;
  std::ranges::copy_if(text, std::back_inserter(letters), is_letter);
  return letters;
}

/// Length of what all names but the first begin with, up to and with its last separator. The first
/// is the root, which may be called anything.
std::size_t common_start(const std::vector<std::string>& texts) {
  if (texts.size() < 4) return 0;
  const std::string& one = texts[1];
  std::size_t common = one.size();
  for (const std::string& other : texts) {
    if (&other == &texts.front()) continue;
    const auto ends = std::ranges::mismatch(one, other);
    common = std::min(common, static_cast<std::size_t>(ends.in1 - one.begin()));
  }
  const auto separator = one.substr(0, common).rfind(' ');
  return separator == std::string::npos ? 0 : separator + 1;
}

/// The text without the words of kProgramWords, and the digits at their ends, at its beginning.
std::string without_program(std::string text) {
  for (;;) {
    const auto end = text.find(' ');
    if (end == std::string::npos) return text;
    std::string_view word = std::string_view(text).substr(0, end);
    while (!word.empty() && !is_letter(word.back())) word.remove_suffix(1);
    if (std::ranges::find(kProgramWords, word) == kProgramWords.end()) return text;
    text.erase(0, end + 1);
  }
}

/// Whether a letter stands between blanks or ends.
bool stands_alone(std::string_view text, std::size_t at) {
  return (at == 0 || text[at - 1] == ' ') && (at + 1 == text.size() || text[at + 1] == ' ');
}

std::optional<JointWord> middle(const std::string& text) {
  if (const auto word = look_up(kMiddle, letters_of(text))) return word;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (kMiddleMarks.find(text[at]) == std::string_view::npos || !stands_alone(text, at)) continue;
    std::string rest = text;
    if (const auto word = look_up(kMiddle, letters_of(rest.erase(at, 1)))) return word;
  }
  return {};
}

/// The sided word left when the `length` letters from `at` that mark the side are taken out.
std::optional<NamedJoint> sided(const std::string& text, std::size_t at, std::size_t length,
                                Side side) {
  std::string rest = text;
  rest.erase(at, length);
  if (const auto word = look_up(kSided, letters_of(rest))) return NamedJoint{*word, side};
  return {};
}

std::optional<NamedJoint> sided(const std::string& text) {
  for (const auto& [mark, side] :
       {std::pair{std::string("left"), Side::left}, std::pair{std::string("right"), Side::right}}) {
    if (const auto at = text.find(mark); at != std::string::npos)
      return sided(text, at, mark.size(), side);
    const char letter = mark.front();
    // lfemur, l thigh; thigh l; bip l thigh.
    if (text.front() == letter)
      if (const auto found = sided(text, 0, 1, side)) return found;
    for (std::size_t at = 1; at < text.size(); ++at) {
      if (text[at] != letter || !stands_alone(text, at)) continue;
      if (const auto found = sided(text, at, 1, side)) return found;
    }
  }
  return {};
}

}  // namespace

std::vector<std::optional<NamedJoint>> named_joints(const std::vector<std::string>& names) {
  std::vector<std::string> texts;
  texts.reserve(names.size());
  for (const std::string& name : names)
    texts.push_back(simplified(name.substr(name.rfind(':') + 1)));
  const std::size_t start = common_start(texts);
  std::vector<std::optional<NamedJoint>> joints;
  for (std::string& text : texts) {
    if (&text != &texts.front() || text.starts_with(texts.back().substr(0, start)))
      text.erase(0, std::min(start, text.size()));
    text = without_program(std::move(text));
    std::optional<NamedJoint> joint;
    if (!text.empty()) joint = sided(text);
    if (const auto word = middle(text); !joint && word) joint = NamedJoint{*word, Side::middle};
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace mcdbn
