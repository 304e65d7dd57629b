// Clips in one frame matrix, the windows in them, and the codes of a stack of layers.

#include "mcdbn/machines/sequences.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/cdbn.hpp"
#include "reference/error_bounds.hpp"
#include "reference/running_error.hpp"

namespace sequences_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::Bounded;
using reference::exact;
using reference::misfit;

namespace {

std::vector<MatrixF> clips_of(const std::vector<std::size_t>& frames, std::size_t columns) {
  std::vector<MatrixF> clips;
  for (std::size_t i = 0; i < frames.size(); ++i)
    clips.push_back(random_matrix(frames[i], columns, static_cast<unsigned>(i + 1)));
  return clips;
}

CrbmParameters layer(std::size_t visible, std::size_t hidden, std::size_t order, VisibleKind kind,
                     unsigned seed) {
  CrbmParameters p = CrbmParameters::zeros({visible, hidden, order, kind});
  p.W = random_matrix(visible, hidden, seed);
  p.A = random_matrix(order * visible, visible, seed + 1);
  p.B = random_matrix(order * visible, hidden, seed + 2);
  p.a = random_matrix(1, visible, seed + 3);
  p.b = random_matrix(1, hidden, seed + 4);
  return p;
}

/// One layer's codes of one clip's frames; those before `first` stay empty.
std::vector<Bounded> codes(const CrbmParameters& p, const std::vector<Bounded>& frames,
                           std::size_t first) {
  std::vector<Bounded> result(frames.size());
  for (std::size_t t = first; t < frames.size(); ++t) {
    reference::Sum input;
    input.add(exact(p.b)).add_product(frames[t], exact(p.W));
    const auto visible = static_cast<Eigen::Index>(p.shape.visible);
    for (std::size_t q = 0; q < p.shape.order; ++q)
      input.add_product(frames[t - p.shape.order + q],
                        exact(p.B.middleRows(static_cast<Eigen::Index>(q) * visible, visible)));
    result[t] = reference::sigmoid(input.result());
  }
  return result;
}

}  // namespace

TEST_CASE("small: clips lie one after another and come back as they were") {
  on_every_device([](Device& device) {
    const auto clips = clips_of({4, 1, 0, 7}, 3);
    const Sequences sequences = Sequences::from_host(device, clips);
    CHECK(sequences.valid_from == 0);
    CHECK(sequences.values.rows() == 12);
    REQUIRE(sequences.clips.size() == 4);
    const std::array<std::size_t, 4> first{0, 4, 5, 5}, frames{4, 1, 0, 7};
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(sequences.clips[i].first == first[i]);
      CHECK(sequences.clips[i].frames == frames[i]);
    }
    const auto back = sequences.to_host();
    REQUIRE(back.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) CHECK(back[i] == clips[i]);
    CHECK_THROWS_AS(Sequences::from_host(device, {clips[0], random_matrix(3, 4, 1)}), ShapeError);
  });
}

TEST_CASE("windows: every row with a whole history in its own clip, the first one too") {
  Sequences sequences;
  sequences.clips = {{0, 4}, {4, 2}, {6, 3}, {9, 0}, {9, 5}};
  using Numbers = std::vector<std::int32_t>;
  CHECK(sequences.window_rows(0) == Numbers{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13});
  CHECK(sequences.window_rows(2) == Numbers{2, 3, 8, 11, 12, 13});
  CHECK(sequences.window_rows(4) == Numbers{13});
  CHECK(sequences.window_rows(5).empty());
  sequences.valid_from = 1;  // codes of a layer that looks one frame back
  CHECK(sequences.window_rows(0) == Numbers{1, 2, 3, 5, 7, 8, 10, 11, 12, 13});
  CHECK(sequences.window_rows(2) == Numbers{3, 12, 13});
  sequences.valid_from = 2;
  CHECK(sequences.window_rows(1) == Numbers{3, 12, 13});
}

TEST_CASE("small: a stack's codes keep the rows of their frames and know their own clip only") {
  // Hidden layers as large as visible ones, and orders that differ.
  const std::vector<std::vector<CrbmParameters>> stacks = {
      {layer(5, 5, 2, VisibleKind::gaussian, 10), layer(5, 5, 1, VisibleKind::binary, 20),
       layer(5, 5, 3, VisibleKind::binary, 30)},
      {layer(3, 7, 1, VisibleKind::gaussian, 40), layer(7, 4, 3, VisibleKind::binary, 50)},
      {layer(3, 6, 0, VisibleKind::gaussian, 60)}};
  const std::vector<std::size_t> total_orders{6, 4, 0};
  on_every_device([&](Device& device) {
    for (std::size_t s = 0; s < stacks.size(); ++s) {
      Cdbn cdbn;
      for (const CrbmParameters& p : stacks[s]) cdbn.layers.emplace_back(device, p);
      CHECK(cdbn.total_order() == total_orders[s]);
      CHECK(cdbn.code_dimension() == stacks[s].back().shape.hidden);
      const auto clips = clips_of({9, 3, 7, 6, 8}, stacks[s].front().shape.visible);
      const Sequences code = cdbn.up_pass(Sequences::from_host(device, clips));
      CHECK(code.valid_from == total_orders[s]);
      const auto got = code.to_host();
      REQUIRE(got.size() == clips.size());
      for (std::size_t i = 0; i < clips.size(); ++i) {
        std::vector<Bounded> want;
        for (Eigen::Index t = 0; t < clips[i].rows(); ++t) want.push_back(exact(clips[i].row(t)));
        std::size_t first = 0;
        for (const CrbmParameters& p : stacks[s]) want = codes(p, want, first += p.shape.order);
        REQUIRE(got[i].rows() == clips[i].rows());
        for (std::size_t t = 0; t < want.size(); ++t) {
          CAPTURE(i);
          CAPTURE(t);
          const auto row = got[i].row(static_cast<Eigen::Index>(t));
          if (t < total_orders[s])
            CHECK((row.array() == 0.0F).all());
          else
            CHECK(misfit(row, want[t].value, want[t].bound) == "");
        }
      }
    }
  });
}

TEST_CASE("small: codes of codes count the frames that were valid before") {
  on_every_device([](Device& device) {
    const Crbm one(device, layer(4, 4, 2, VisibleKind::binary, 3));
    Sequences visible = Sequences::from_host(device, clips_of({6, 4}, 4));
    visible.valid_from = 1;
    const Sequences code = up_pass(one, visible);
    CHECK(code.valid_from == 3);
    CHECK(code.window_rows(1) == std::vector<std::int32_t>{4, 5});
    CHECK(code.window_rows(0) == std::vector<std::int32_t>{3, 4, 5, 9});
    const MatrixF values = code.values.to_host();
    for (const Eigen::Index without : {0, 1, 2, 6, 7, 8})
      CHECK((values.row(without).array() == 0.0F).all());
    for (const Eigen::Index with : {3, 4, 5, 9}) CHECK((values.row(with).array() > 0.0F).all());
    CHECK_THROWS_AS(Cdbn{}.up_pass(visible), ShapeError);
  });
}

}  // namespace sequences_test
