#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/seen_people.hpp"

namespace mcdbn {

/// Follows one person from frame to frame, without knowing those that come: by the file's number of
/// the person, else as the one nearest to where the person was seen last, within half a body, more
/// the longer ago that is. A person unseen for longer than 1.5 s is given up, and the choice is
/// made anew.
class PersonChoice {
 public:
  /// @param person largest, or a number: 1 is the largest of the first frame that shows so many
  /// @throws ConfigError if it is neither
  explicit PersonChoice(const std::string& person);
  std::size_t number() const { return number_; }

  /// @param patience frames for which the person may be unseen  @return none: not in this frame
  std::optional<std::size_t> choose(const std::vector<SeenPerson>& people, double patience);

 private:
  std::size_t number_ = 1;
  std::optional<SeenPerson> last_;
  double size_px_ = 0;  ///< the largest box that was seen of them
  int away_ = 0;        ///< frames since
};

}  // namespace mcdbn
