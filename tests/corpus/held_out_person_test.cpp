#include "corpus/held_out_person.hpp"

#include <doctest/doctest.h>

#include "features/small_figure.hpp"
#include "mcdbn/corpus/training_set.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct Clip {
  std::size_t person;
  const char* file;
  Eigen::Index frames;
};

TrainingSet views_from(const std::vector<Clip>& clips) {
  const SmallFigure figure;
  TrainingSet views{figure.modalities(), {}, {}, {}, {}, {}};
  for (const Clip& clip : clips) {
    views.tracks.push_back(MatrixF::Zero(clip.frames, 4));
    views.poses.push_back(MatrixF::Zero(clip.frames, 6));
    views.clips.push_back({std::string("/data/") + clip.file, ""});
    views.people.push_back(clip.person);
  }
  return views;
}

}  // namespace

TEST_CASE("who is held out: of those with several clips the one with the fewest frames") {
  const std::vector<Clip> clips{{0, "a1", 100}, {0, "a2", 90}, {1, "b1", 20}, {1, "b1", 20},
                                {2, "c1", 40},  {2, "c2", 40}, {3, "d1", 70}, {3, "d2", 50}};
  CHECK(person_to_hold_out(views_from(clips), 4) == 2U);  // b has two views of a single clip
  const TrainingSet views = views_from(clips);
  CHECK(clip_names(views_of(views, 2)) == std::vector<std::string>{"c1", "c2"});
  CHECK(clip_names(views_without(views, 2)) ==
        std::vector<std::string>{"a1", "a2", "b1", "d1", "d2"});
  CHECK(views_of(views, 2).groups.empty());
  TrainingSet grouped = views;
  grouped.groups = {0, 1, 2, 2, 3, 4, 5, 5};
  CHECK(views_of(grouped, 2).groups == std::vector<std::size_t>{3, 4});
  CHECK(views_without(grouped, 2).groups == std::vector<std::size_t>{0, 1, 2, 2, 5, 5});
}

TEST_CASE("who is held out: of people with a clip each the one with the fewest frames") {
  CHECK(person_to_hold_out(views_from({{0, "a", 50}, {1, "b", 30}, {2, "c", 20}, {3, "d", 90}}),
                           4) == 2U);
}

TEST_CASE("no person is held out of too few, nor where people are unknown or none is asked for") {
  TrainingSet views = views_from({{0, "a", 50}, {1, "b", 30}, {2, "c", 20}, {3, "d", 90}});
  CHECK(person_to_hold_out(views, 4));
  CHECK_FALSE(person_to_hold_out(views, 5));
  CHECK_FALSE(person_to_hold_out(views, 0));
  CHECK_FALSE(person_to_hold_out(views_from({{0, "a", 50}}), 1));  // one has to stay
  views.people.clear();
  CHECK_FALSE(person_to_hold_out(views, 4));
}
