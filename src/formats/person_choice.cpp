#include "formats/person_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "formats/person_box.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// How far a person may be from where they were last, as a share of the body's box's diagonal;
/// three times as far at the end of the patience.
constexpr double kReachOfChosen = 0.5, kChosenReachGrows = 2;

/// Whether any joint is.
bool is_seen(const SeenPerson& person) {
  return std::ranges::any_of(person.confidence, [](double sure) { return sure > 0; });
}

double size_px(const SeenPerson& person) {
  return box_of(person).diagonal();
}

/// Mean distance of the joints that both show; infinite where they share none.
double distance_px(const SeenPerson& one, const SeenPerson& other) {
  double sum = 0;
  int shared = 0;
  for (std::size_t joint = 0; joint < std::min(one.x_px.size(), other.x_px.size()); ++joint) {
    if (!(one.confidence[joint] > 0 && other.confidence[joint] > 0)) continue;
    sum += std::hypot(one.x_px[joint] - other.x_px[joint], one.y_px[joint] - other.y_px[joint]);
    ++shared;
  }
  return shared == 0 ? std::numeric_limits<double>::infinity() : sum / shared;
}

}  // namespace

PersonChoice::PersonChoice(const std::string& person) {
  if (person == "largest") return;
  const char* end = person.data() + person.size();
  const auto [rest, error] = std::from_chars(person.data(), end, number_);
  if (error != std::errc() || rest != end || number_ == 0)
    throw ConfigError(fmt::format(
        "`person` {}: for a track that is followed as it grows give largest, or a number from 1 on",
        person));
}

std::optional<std::size_t> PersonChoice::choose(const std::vector<SeenPerson>& people,
                                                double patience) {
  if (last_ && ++away_ > patience) last_.reset();
  std::optional<std::size_t> chosen;
  if (!last_) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < people.size(); ++i)
      if (is_seen(people[i])) order.push_back(i);
    std::ranges::stable_sort(order, std::greater(),
                             [&](std::size_t i) { return size_px(people[i]); });
    if (order.size() >= number_) chosen = order[number_ - 1];
  } else {
    double nearest = kReachOfChosen * size_px_ * (1 + kChosenReachGrows * away_ / patience);
    bool by_number = false;
    for (std::size_t i = 0; i < people.size(); ++i) {
      if (!is_seen(people[i])) continue;
      const long long number = people[i].id.value_or(-1), wanted = last_->id.value_or(-1);
      const bool numbered = number >= 0 && wanted >= 0;
      if (numbered ? number != wanted : by_number) continue;
      const double away = distance_px(*last_, people[i]);
      // The number finds a person at any distance, and before anyone without a number.
      if (!(away < nearest) && by_number == numbered) continue;
      by_number = numbered;
      nearest = away;
      chosen = i;
    }
  }
  if (!chosen) return {};
  if (!last_) size_px_ = 0;
  last_ = people[*chosen];
  size_px_ = std::max(size_px_, size_px(*last_));
  away_ = 0;
  return chosen;
}

}  // namespace mcdbn
