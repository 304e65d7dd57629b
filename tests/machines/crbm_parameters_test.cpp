// Parameters on their way to the device and back, and what a layer makes of its rows.

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "machines/two_modalities.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/crbm.hpp"
#include "mcdbn/machines/mrbm.hpp"
#include "reference/error_bounds.hpp"
#include "reference/mrbm_chain_reference.hpp"

namespace crbm_parameters_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::Bounded;
using reference::exact;
using reference::misfit;
using reference::Sum;

namespace {

const std::vector<CrbmShape> kShapes = {
    {1, 1, 1, VisibleKind::gaussian},       {5, 5, 2, VisibleKind::binary},
    {16, 16, 1, VisibleKind::gaussian},     {17, 3, 5, VisibleKind::gaussian},
    {3, 17, 4, VisibleKind::binary},        {7, 7, 0, VisibleKind::binary},
    {5, 3, 4, VisibleKind::gaussian, 4, 1}, {3, 4, 2, VisibleKind::binary, 0, 2}};

/// Every matrix with entries of its own.
CrbmParameters filled(const CrbmShape& shape, unsigned seed) {
  CrbmParameters p = CrbmParameters::zeros(shape);
  for (MatrixF* matrix : {&p.W, &p.A, &p.B, &p.a, &p.b, &p.visible_mean, &p.visible_deviation})
    *matrix = random_matrix(static_cast<std::size_t>(matrix->rows()),
                            static_cast<std::size_t>(matrix->cols()), ++seed);
  return p;
}

/// The `order` frames before row t, oldest first (eq 15).
RowVectorF history_of(const MatrixF& frames, Eigen::Index t, Eigen::Index order) {
  RowVectorF history(order * frames.cols());
  for (Eigen::Index q = 0; q < order; ++q)
    history.segment(q * frames.cols(), frames.cols()) = frames.row(t - order + q);
  return history;
}

void check_same(const CrbmParameters& got, const CrbmParameters& want) {
  CHECK(got.shape == want.shape);
  CHECK(got.W == want.W);
  CHECK(got.A == want.A);
  CHECK(got.B == want.B);
  CHECK(got.a == want.a);
  CHECK(got.b == want.b);
  CHECK(got.visible_mean == want.visible_mean);
  CHECK(got.visible_deviation == want.visible_deviation);
}

}  // namespace

TEST_CASE("small: a CRBM's parameters come back from the device, each in its place") {
  on_every_device([](Device& device) {
    for (const CrbmShape& shape : kShapes) {
      INFO(shape.visible, " visible, ", shape.hidden, " hidden, order ", shape.order);
      const CrbmParameters want = filled(shape, 100);
      const Crbm layer(device, want);
      CHECK(layer.shape() == shape);
      check_same(layer.to_host(), want);
      CHECK(layer.W_transposed.to_host() == want.W.transpose());
      for (const Matrix* matrix : {&layer.W, &layer.A, &layer.B, &layer.a, &layer.b,
                                   &layer.visible_mean, &layer.W_transposed})
        if (matrix->rows() > 0) CHECK(padding_is_zero(*matrix));
    }
  });
}

TEST_CASE("small: a CRBM's transposed weights follow W when they are refreshed") {
  on_every_device([](Device& device) {
    Crbm layer(device, filled({5, 5, 1, VisibleKind::gaussian}, 1));
    const MatrixF other = random_matrix(5, 5, 77);
    layer.W.upload(other);
    layer.refresh_transposed();
    CHECK(layer.W_transposed.to_host() == other.transpose());
    CHECK(layer.to_host().W == other);
  });
}

TEST_CASE("small: a CRBM's parameters that do not fit its shape are refused") {
  on_every_device([](Device& device) {
    const CrbmShape shape{5, 3, 2, VisibleKind::gaussian};
    const CrbmParameters whole = filled(shape, 1);
    for (MatrixF CrbmParameters::*matrix :
         {&CrbmParameters::W, &CrbmParameters::a, &CrbmParameters::b}) {
      CrbmParameters p = whole;
      (p.*matrix) = random_matrix(static_cast<std::size_t>((whole.*matrix).rows()),
                                  static_cast<std::size_t>((whole.*matrix).cols()) + 1, 9);
      CHECK_THROWS_AS(Crbm(device, p), ShapeError);
    }
    CrbmParameters turned = whole;
    CrbmShape too_long = shape;
    too_long.own_order_A = 3;
    CHECK_THROWS_AS(Crbm::parameter_shapes(too_long), ShapeError);
    too_long = shape;
    too_long.own_order_B = 3;
    CHECK_THROWS_AS(Crbm::parameter_shapes(too_long), ShapeError);
    turned.shape = {3, 5, 2, VisibleKind::gaussian};
    turned.A = random_matrix(6, 3, 9);
    turned.B = random_matrix(6, 5, 9);
    CHECK_THROWS_AS(Crbm(device, turned), ShapeError);
  });
}

TEST_CASE("small: a layer's biases and hidden probabilities are eq 11, 16 and 17 for every row") {
  on_every_device([](Device& device) {
    for (const CrbmShape& shape : kShapes) {
      INFO(shape.visible, " visible, ", shape.hidden, " hidden, order ", shape.order);
      const CrbmParameters p = filled(shape, 40);
      const Crbm layer(device, p);
      const std::size_t first = shape.order + 1, count = 6;
      const MatrixF frames = random_matrix(first + count + 2, shape.visible, 7);
      const Matrix on_device = Matrix::from_host(device, frames);
      const Rows rows(on_device, first, count);
      const Matrix visible(device, count, shape.visible), hidden(device, count, shape.hidden),
          code(device, count, shape.hidden);
      layer.hidden_probabilities(rows, code);
      if (shape.order > 0) {
        layer.dynamic_visible_bias(rows, visible);
        layer.dynamic_hidden_bias(rows, hidden);
      }
      for (std::size_t i = 0; i < count; ++i) {
        const auto t = static_cast<Eigen::Index>(first + i), row = static_cast<Eigen::Index>(i);
        const auto history = [&](std::size_t order) {
          return exact(history_of(frames, t, static_cast<Eigen::Index>(order)));
        };
        const Bounded visible_bias =
            Sum().add(exact(p.a)).add_product(history(shape.order_A()), exact(p.A)).result();
        Sum hidden_input = Sum().add(exact(p.b)).add_product(history(shape.order_B()), exact(p.B));
        const Bounded hidden_bias = hidden_input.result();
        if (shape.order > 0) {
          CHECK(misfit(visible.to_host().row(row), visible_bias.value, visible_bias.bound) == "");
          CHECK(misfit(hidden.to_host().row(row), hidden_bias.value, hidden_bias.bound) == "");
        }
        hidden_input.add_product(exact(frames.row(t)), exact(p.W));
        const Bounded want = reference::sigmoid(hidden_input.result());
        CHECK(misfit(code.to_host().row(row), want.value, want.bound) == "");
      }
    }
  });
}

TEST_CASE("small: a row's history begins `order` rows before it, by number and by index") {
  on_every_device([](Device& device) {
    const CrbmParameters p = filled({3, 4, 3, VisibleKind::gaussian}, 5);
    const Crbm layer(device, p);
    const MatrixF frames = random_matrix(12, 3, 8);
    const Matrix on_device = Matrix::from_host(device, frames);
    CHECK_THROWS_AS(layer.history(Rows(on_device, 2, 4)), ShapeError);
    const IndexBuffer index(device, {9, 3, 11, 6, 4});
    const Rows picked = Rows::indexed(on_device, index, 1, 3);
    const Matrix out(device, 3, 4), one(device, 1, 4);
    layer.hidden_probabilities(picked, out);
    const std::array<std::size_t, 3> rows{3, 11, 6};
    for (std::size_t i = 0; i < rows.size(); ++i) {
      layer.hidden_probabilities(Rows(on_device, rows[i], 1), one);
      CHECK((out.to_host().row(static_cast<Eigen::Index>(i)) - one.to_host().row(0))
                .cwiseAbs()
                .maxCoeff() < 1e-6F);
    }
  });
}

TEST_CASE("random weights: each matrix has draws of its own, biases are zero") {
  const RandomKey key{5, 3, 2, 9};
  const CrbmParameters p = CrbmParameters::random({6, 6, 1, VisibleKind::binary}, 0.25, key);
  // W, A and B in that order are the phases after the key's own.
  std::uint16_t phase = 9;
  for (const MatrixF* matrix : {&p.W, &p.A, &p.B}) {
    const RandomKey own{5, 3, 2, ++phase};
    for (std::uint32_t r = 0; r < 6; ++r)
      for (std::uint32_t c = 0; c < 6; ++c)
        CHECK((*matrix)(r, c) == static_cast<float>(0.25 * random_normal(own, r, c)));
  }
  for (const MatrixF* bias : {&p.a, &p.b, &p.visible_mean}) CHECK((*bias == MatrixF::Zero(1, 6)));
}

TEST_CASE("small: an MRBM's parameters come back from the device, each modality in its place") {
  on_every_device([](Device& device) {
    for (const auto& [track, pose, hidden] :
         std::vector<std::array<std::size_t, 3>>{{5, 5, 5}, {16, 16, 16}, {3, 7, 19}, {9, 1, 2}}) {
      const MrbmParameters want = mrbm_of(
          {random_matrix(track, hidden, 1), random_matrix(pose, hidden, 2)},
          {random_matrix(1, track, 3), random_matrix(1, pose, 4)}, random_matrix(1, hidden, 5));
      const Mrbm mrbm(device, want);
      CHECK(mrbm.visible(modality::track) == track);
      CHECK(mrbm.visible(modality::pose) == pose);
      CHECK(mrbm.hidden() == hidden);
      const MrbmParameters got = mrbm.to_host();
      for (std::size_t m = 0; m < 2; ++m) {
        CHECK(got.W[m] == want.W[m]);
        CHECK(got.a[m] == want.a[m]);
        CHECK(mrbm.W_transposed[m].to_host() == want.W[m].transpose());
      }
      CHECK(got.b == want.b);
    }
  });
}

TEST_CASE("small: an MRBM's parameters that do not fit together are refused") {
  on_every_device([](Device& device) {
    const MrbmParameters whole = MrbmParameters::random(two_modalities(4, 6, 5), 1.0, {});
    MrbmParameters turned = whole;
    std::swap(turned.a[0], turned.a[1]);
    CHECK_THROWS_AS(Mrbm(device, turned), ShapeError);
    MrbmParameters narrow = whole;
    narrow.W[1] = random_matrix(6, 4, 1);
    CHECK_THROWS_AS(Mrbm(device, narrow), ShapeError);
    MrbmParameters other_bias = whole;
    other_bias.b = random_matrix(1, 6, 1);
    CHECK_THROWS_AS(Mrbm(device, other_bias), ShapeError);
  });
}

TEST_CASE("random MRBM weights: each modality has draws of its own") {
  const MrbmParameters p = MrbmParameters::random(two_modalities(4, 4, 3), 0.5, {8, 6, 2, 5});
  for (std::uint32_t m = 0; m < 2; ++m) {
    CHECK((p.a[m] == MatrixF::Zero(1, 4)));
    const RandomKey own{8, 6 + m, 2, 6};  // a step for each modality
    for (std::uint32_t r = 0; r < 4; ++r)
      for (std::uint32_t c = 0; c < 3; ++c)
        CHECK(p.W[m](r, c) == static_cast<float>(0.5 * random_normal(own, r, c)));
  }
  CHECK((p.b == MatrixF::Zero(1, 3)));
}

TEST_CASE("small: inference of the MRBM is so many steps from the modality that is present") {
  on_every_device([](Device& device) {
    // Alike in size, so that a modality in the other's place would fit.
    const MrbmParameters p =
        mrbm_of({random_matrix(5, 4, 1, 2.0F), random_matrix(5, 4, 2, 2.0F)},
                {random_matrix(1, 5, 3), random_matrix(1, 5, 4)}, random_matrix(1, 4, 5));
    const Mrbm mrbm(device, p);
    const MatrixF codes = (0.5F * (random_matrix(6, 5, 6).array() + 1.0F)).matrix();
    const Matrix present = Matrix::from_host(device, codes), absent(device, 6, 5);
    for (const std::size_t modality : {modality::track, modality::pose})
      for (const std::size_t steps : {0U, 1U, 2U, 7U}) {
        const reference::ClampedChain mean_field{std::max(static_cast<int>(steps), 1), 0.0};
        const Bounded want = reference::bounded_clamped_chain(
            {{p.W[0].cast<double>(), p.W[1].cast<double>()},
             {p.a[0].cast<double>(), p.a[1].cast<double>()},
             p.b.cast<double>()},
            static_cast<int>(modality), codes.cast<double>(), mean_field, {});
        mrbm.infer(in_order(modality, present, absent), only(modality), steps);
        CHECK(misfit(absent.to_host(), want.value, want.bound) == "");
      }
  });
}

}  // namespace crbm_parameters_test
