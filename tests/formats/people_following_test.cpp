#include "formats/people_following.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "base/interruption.hpp"
#include "formats/assignment.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

namespace {

using Frames = std::vector<std::vector<SeenPerson>>;

/// Ten joints from head to foot, of this height, that stand at x.
SeenPerson person_at(double x, double height_px = 200) {
  SeenPerson person;
  for (int joint = 0; joint < 10; ++joint) {
    person.x_px.push_back(x + (joint % 2 == 0 ? -0.15 : 0.15) * height_px);
    person.y_px.push_back(100 + height_px * joint / 9);
    person.confidence.push_back(0.8);
  }
  return person;
}

SeenPerson numbered_at(double x, long long number) {
  SeenPerson person = person_at(x);
  person.id = number;
  return person;
}

void hide(SeenPerson& person, int first, int last) {
  for (int joint = first; joint <= last; ++joint) person.confidence[joint] = 0;
  mark_missing(person);
}

/// Where the followed person is in a frame; NaN: not seen.
double x_of(const Frames& frames, const Followed& followed, std::size_t frame) {
  const auto at = std::ranges::find(followed, static_cast<int>(frame), &Sighting::frame);
  if (at == followed.end()) return std::numeric_limits<double>::quiet_NaN();
  const SeenPerson& person = frames[frame][at->person];
  return std::accumulate(person.x_px.begin(), person.x_px.end(), 0.0) / 10;
}

double cost_of(const MatrixD& costs, const std::vector<int>& assignment) {
  double sum = 0;
  for (std::size_t row = 0; row < assignment.size(); ++row)
    if (assignment[row] >= 0) sum += costs(static_cast<Eigen::Index>(row), assignment[row]);
  return sum;
}

double cheapest_by_trying_all(const MatrixD& costs) {
  std::vector<int> order(static_cast<std::size_t>(std::max(costs.rows(), costs.cols())));
  std::iota(order.begin(), order.end(), 0);
  double cheapest = 1e300;
  do {
    double sum = 0;
    for (std::size_t i = 0; i < order.size(); ++i)
      if (static_cast<Eigen::Index>(i) < costs.rows() && order[i] < costs.cols())
        sum += costs(static_cast<Eigen::Index>(i), order[i]);
    cheapest = std::min(cheapest, sum);
  } while (std::ranges::next_permutation(order).found);
  return cheapest;
}

}  // namespace

TEST_CASE("assignment: as cheap as the cheapest of all, each column once") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> cost(0, 10);
  for (int trial = 0; trial < 60; ++trial) {
    MatrixD costs(1 + trial % 5, 1 + trial % 4);
    for (Eigen::Index i = 0; i < costs.size(); ++i) costs.data()[i] = cost(random);
    const std::vector<int> assignment = cheapest_assignment(costs);
    REQUIRE(assignment.size() == static_cast<std::size_t>(costs.rows()));
    std::multiset<int> used(assignment.begin(), assignment.end());
    for (int column = 0; column < costs.cols(); ++column) CHECK(used.count(column) <= 1);
    CHECK(static_cast<Eigen::Index>(assignment.size() - used.count(-1)) ==
          std::min(costs.rows(), costs.cols()));
    CHECK(cost_of(costs, assignment) == doctest::Approx(cheapest_by_trying_all(costs)));
  }
}

TEST_CASE("people: two who cross, listed in any order, stay who they are") {
  Frames frames;
  std::mt19937 random(5);
  for (int frame = 0; frame < 40; ++frame) {
    frames.push_back({person_at(100 + 10 * frame), person_at(500 - 10 * frame, 180)});
    if (random() % 2 == 0) std::swap(frames.back()[0], frames.back()[1]);
  }
  const auto people = follow_people(frames, 30);
  REQUIRE(people.size() == 2);
  for (std::size_t frame = 0; frame < 40; ++frame) {
    CHECK(x_of(frames, people[0], frame) == doctest::Approx(100.0 + 10 * frame));
    CHECK(x_of(frames, people[1], frame) == doctest::Approx(500.0 - 10 * frame));
  }
}

TEST_CASE("people: who is hidden for a short time is the same afterwards") {
  Frames frames;
  for (int frame = 0; frame < 40; ++frame) {
    frames.push_back({person_at(100 + 10 * frame)});
    // Behind the first while they cross.
    if (frame < 15 || frame > 25) frames.back().push_back(person_at(500 - 10 * frame, 150));
  }
  const auto people = follow_people(frames, 30);
  REQUIRE(people.size() == 2);
  CHECK(x_of(frames, people[1], 14) == doctest::Approx(360));
  CHECK(std::isnan(x_of(frames, people[1], 20)));
  CHECK(x_of(frames, people[1], 26) == doctest::Approx(240));
  CHECK(x_of(frames, people[0], 26) == doctest::Approx(360));
  // Whoever comes after the patience has ended is another one.
  CHECK(follow_people(frames, 5).size() == 3);
}

TEST_CASE("people: a body that is found in parts stays the one that it was") {
  Frames frames;
  for (int frame = 0; frame < 30; ++frame) {
    frames.push_back({person_at(200 + 4 * frame)});
    if (frame % 7 != 6) continue;
    frames.back().push_back(frames.back()[0]);
    hide(frames.back()[0], 0, 4);
    hide(frames.back()[1], 5, 9);
    if (frame % 2 == 0) std::swap(frames.back()[0], frames.back()[1]);
  }
  const auto people = follow_people(frames, 30);
  CHECK(people[0].size() == frames.size());
}

TEST_CASE("people: the file's own numbers hold where each is there once") {
  Frames frames;
  for (int frame = 0; frame < 6; ++frame) {
    frames.push_back({person_at(100), person_at(300)});
    // By the tracker's numbers they have changed places.
    frames.back()[0].id = frame < 3 ? 7 : 9;
    frames.back()[1].id = frame < 3 ? 9 : 7;
  }
  auto people = follow_people(frames, 30);
  REQUIRE(people.size() == 2);
  CHECK(x_of(frames, people[0], 0) != x_of(frames, people[0], 5));
  for (auto& frame : frames) frame[1].id = frame[0].id = 0;  // the same number for both
  people = follow_people(frames, 30);
  REQUIRE(people.size() == 2);
  CHECK(x_of(frames, people[0], 0) == x_of(frames, people[0], 5));
}

TEST_CASE("people: where one number ends and another begins it is the same person") {
  Frames frames;
  for (int frame = 0; frame < 60; ++frame) {
    frames.push_back({numbered_at(900, 3)});
    if (frame >= 40 && frame < 45) continue;  // while the tracker has lost them
    frames.back().push_back(numbered_at(100 + 4 * frame, frame < 20 ? 1 : frame < 40 ? 7 : 2));
  }
  const auto people = follow_people(frames, 30);
  REQUIRE(people.size() == 2);
  CHECK(people[0].size() == 60);
  CHECK(people[1].size() == 55);
  CHECK(x_of(frames, people[1], 0) == doctest::Approx(100));
  CHECK(x_of(frames, people[1], 59) == doctest::Approx(336));
  const auto changes = number_changes(frames, people);
  REQUIRE(changes.size() == 2);
  CHECK(changes[0].before == 1);
  CHECK(changes[0].after == 7);
  CHECK(changes[0].frame == 20);
  CHECK(changes[1].before == 7);
  CHECK(changes[1].after == 2);
  CHECK(changes[1].frame == 45);
}

TEST_CASE("people: who is hidden while they cross is the same with a new number, too") {
  Frames frames;
  for (int frame = 0; frame < 40; ++frame) {
    frames.push_back({numbered_at(100 + 10 * frame, 1)});
    if (frame < 15 || frame > 25)
      frames.back().push_back(numbered_at(500 - 10 * frame, frame < 15 ? 2 : 9));
  }
  const auto people = follow_people(frames, 30);
  REQUIRE(people.size() == 2);
  for (std::size_t frame = 0; frame < 40; ++frame)
    CHECK(x_of(frames, people[0], frame) == doctest::Approx(100.0 + 10 * frame));
  CHECK(x_of(frames, people[1], 14) == doctest::Approx(360));
  CHECK(x_of(frames, people[1], 26) == doctest::Approx(240));
}

TEST_CASE("people: numbers of two who cross are two people, also if one ends in the middle") {
  for (const int end : {40, 20}) {
    CAPTURE(end);
    Frames frames;
    for (int frame = 0; frame < 40; ++frame) {
      frames.push_back({numbered_at(500 - 10 * frame, 2)});
      if (frame < end) frames.back().push_back(numbered_at(100 + 10 * frame, 1));
    }
    const auto people = follow_people(frames, 30);
    REQUIRE(people.size() == 2);
    CHECK(people[0].size() == 40);
    CHECK(people[1].size() == static_cast<std::size_t>(end));
    CHECK(number_changes(frames, people).empty());
  }
}

TEST_CASE("people: a number that begins elsewhere, or after a long time, is another person") {
  const auto people_of = [](double from_x, int first) {
    Frames frames;
    for (int frame = 0; frame < 80; ++frame) {
      frames.emplace_back();
      if (frame < 20) frames.back().push_back(numbered_at(100, 1));
      if (frame >= first) frames.back().push_back(numbered_at(from_x, 2));
    }
    return follow_people(frames, 30).size();
  };
  CHECK(people_of(100, 49) == 1);
  CHECK(people_of(100, 50) == 2);  // after 31 frames
  CHECK(people_of(400, 25) == 2);
  // While the other number is still seen.
  CHECK(people_of(100, 19) == 2);
}

TEST_CASE("people: a number that fits two who were lost as well is neither") {
  // One ends at 100, another at 160.
  const auto changes_at = [](double x) {
    Frames frames(20, {numbered_at(100, 1), numbered_at(160, 2)});
    frames.resize(40, {numbered_at(x, 3)});
    return number_changes(frames, follow_people(frames, 30));
  };
  CHECK(changes_at(128).empty());
  REQUIRE(changes_at(100).size() == 1);
  CHECK(changes_at(100).front().before == 1);
  // Two that begin where one ended.
  Frames frames(20, {numbered_at(100, 1)});
  frames.resize(40, {numbered_at(98, 2), numbered_at(104, 3)});
  CHECK(follow_people(frames, 30).size() == 3);
}

TEST_CASE("people: numbers that do not count do not change") {
  Frames frames;
  for (int frame = 0; frame < 10; ++frame)
    frames.push_back({numbered_at(100, frame), numbered_at(600, frame)});
  const auto people = follow_people(frames, 30);
  CHECK(people.size() == 2);
  CHECK(number_changes(frames, people).empty());
}

TEST_CASE("people: who is in few frames of a long film takes little room") {
  // Somebody else in every frame, each with a number and a place of their own.
  Frames frames;
  for (int frame = 0; frame < 5000; ++frame) {
    frames.push_back({person_at(1000.0 * frame)});
    frames.back().front().id = frame;
  }
  const auto people = follow_people(frames, 30);
  REQUIRE(people.size() == frames.size());
  std::size_t numbers = 0;
  for (const Followed& followed : people) numbers += followed.capacity();
  CHECK(numbers < 2 * frames.size());
}

TEST_CASE("people: following them stops when it is asked to") {
  const Frames frames(3, {person_at(100), person_at(300)});
  const MatrixD costs = MatrixD::Ones(2, 2);
  request_interruption();
  bool stopped = false, assigned = true;
  try {
    follow_people(frames, 30);
  } catch (const Interrupted&) {
    stopped = true;
  }
  try {
    cheapest_assignment(costs);
  } catch (const Interrupted&) {
    assigned = false;
  }
  clear_interruption();
  CHECK(stopped);
  CHECK(!assigned);
}

TEST_CASE("people: the largest comes first, over all frames") {
  Frames frames;
  for (int frame = 0; frame < 20; ++frame) {
    frames.push_back({person_at(100, 120), person_at(600, 300)});
    if (frame < 3) frames.back().push_back(person_at(1500, 500));  // large, but soon gone
  }
  const auto people = follow_people(frames, 5);
  REQUIRE(people.size() == 3);
  CHECK(x_of(frames, people[0], 0) == doctest::Approx(600));
  CHECK(x_of(frames, people[1], 0) == doctest::Approx(1500));
  CHECK(x_of(frames, people[2], 0) == doctest::Approx(100));
}
