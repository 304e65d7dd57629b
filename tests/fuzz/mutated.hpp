#pragma once

#include <random>
#include <string>
#include <string_view>

namespace mcdbn::test {

/// The text with one to three small changes: letters changed, cut out, doubled or put in, numbers
/// made extreme, the rest cut off.
inline std::string mutated(std::string text, std::mt19937& random) {
  constexpr std::string_view kLetters = "\"[]{},:.-+0123456789eEx_\n\t ;\x01\xFF";
  constexpr std::string_view kNumbers[] = {
      "-1",         "0",      "1e300", "1e-300", "nan",
      "4294967296", "-1e300", "inf",   "1e9",    "18446744073709551615"};
  const int changes = 1 + static_cast<int>(random() % 3);
  for (int change = 0; change < changes && !text.empty(); ++change) {
    const std::size_t at = random() % text.size(), length = random() % 40;
    switch (random() % 6) {
      case 0:
        text[at] = kLetters[random() % kLetters.size()];
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(random() % text.size(), length));
        break;
      case 3:
        text.resize(at);
        break;
      case 4: {
        const std::size_t number = text.find_first_of("0123456789", at);
        if (number == std::string::npos) break;
        const std::size_t end = text.find_first_not_of("0123456789.eE+-", number);
        text.replace(number, end == std::string::npos ? end : end - number,
                     kNumbers[random() % std::size(kNumbers)]);
        break;
      }
      default:
        text.insert(at, 1, kLetters[random() % kLetters.size()]);
    }
  }
  return text;
}

}  // namespace mcdbn::test
