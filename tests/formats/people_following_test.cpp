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

TEST_CASE("people: who is in few frames of a long film takes little room") {
  // A tracker that gives everybody a new number in every frame.
  Frames frames;
  for (int frame = 0; frame < 5000; ++frame) {
    frames.push_back({person_at(100)});
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
