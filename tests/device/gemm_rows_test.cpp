#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "device/gemm.hpp"
#include "device/pointwise.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/error_bounds.hpp"
#include "reference/product_reference.hpp"

namespace gemm_rows_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::misfit;

namespace {

/// A clip of frames, and windows of it whose order is a jumble with repeats.
struct History {
  std::size_t visible, hidden, frames, windows, order;
};
const std::vector<History> kSmallHistories = {
    {1, 1, 2, 1, 1}, {3, 5, 9, 3, 2}, {17, 7, 11, 5, 3}, {16, 33, 8, 13, 5}, {3, 5, 40, 290, 2}};
const std::vector<History> kModelHistories = {{96, 300, 400, 100, 5}, {190, 300, 400, 100, 5}};

class Windows {
 public:
  Windows(Device& device, const History& shape)
      : shape_(shape),
        frames_(random_matrix(shape.frames, shape.visible, 1)),
        frames_device_(Matrix::from_host(device, frames_)) {
    // Entry i names the frame that follows window i's history.
    std::vector<std::int32_t> entries(kIndexFirst + shape.windows);
    const std::size_t starts = shape.frames - shape.order;
    for (std::size_t i = 0; i < entries.size(); ++i)
      entries[i] = static_cast<std::int32_t>(shape.order + (7 * i + 3) % starts);
    entries_ = entries;
    index_ = IndexBuffer(device, entries);
  }

  /// The frames before each entry, read in place.
  Rows device_rows() const {
    return Rows::indexed(frames_device_, index_, kIndexFirst, shape_.windows,
                         -static_cast<int>(shape_.order), shape_.order);
  }

  /// The same spelled out, with the zeros between frames. [windows x order·stride]
  MatrixF host_rows() const {
    const auto stride = static_cast<Eigen::Index>(frames_device_.stride());
    const auto visible = static_cast<Eigen::Index>(shape_.visible);
    // A window of one frame is an ordinary row, without its padding.
    const auto width =
        shape_.order == 1 ? visible : static_cast<Eigen::Index>(shape_.order) * stride;
    MatrixF rows = MatrixF::Zero(static_cast<Eigen::Index>(shape_.windows), width);
    for (Eigen::Index r = 0; r < rows.rows(); ++r)
      for (Eigen::Index q = 0; q < static_cast<Eigen::Index>(shape_.order); ++q)
        rows.block(r, q * stride, 1, visible) =
            frames_.row(entries_[kIndexFirst + static_cast<std::size_t>(r)] -
                        static_cast<Eigen::Index>(shape_.order) + q);
    return rows;
  }

 private:
  static constexpr std::size_t kIndexFirst = 3;
  History shape_;
  MatrixF frames_;
  Matrix frames_device_;
  std::vector<std::int32_t> entries_;
  IndexBuffer index_;
};

/// Products with rows that are read in place, against the same rows spelled out.
void check_products(Device& device, const Rows& rows, const MatrixF& spelled_out,
                    std::size_t hidden, GemmBackend backend) {
  const auto width = static_cast<std::size_t>(spelled_out.cols());
  // Weights in the padding rows do not matter, as the frames' padding is zero.
  const MatrixF weights = random_matrix(width, hidden, 2);
  const Matrix weights_device = Matrix::from_host(device, weights);
  const GuardedBlock bias(device, rows.count, hidden);
  GemmOptions options;
  options.backend = backend;
  gemm(rows, weights_device, bias.rows(), options);
  const auto want_bias = reference::product(spelled_out.cast<double>(), weights.cast<double>());
  CHECK(misfit(bias.values(), want_bias.value, want_bias.bound) == "");
  CHECK(bias.intact());

  // eq 38, 39: history × (data − reconstruction)
  const MatrixF difference = random_matrix(rows.count, hidden, 3);
  const Matrix difference_device = Matrix::from_host(device, difference);
  const GuardedBlock statistics(device, width, hidden);
  gemm_transposed_a(rows, difference_device, statistics.rows(), 0.01F, 0.0F, backend);
  const auto want_statistics =
      reference::product(spelled_out.transpose().cast<double>(), difference.cast<double>(), 0.01F);
  CHECK(misfit(statistics.values(), want_statistics.value, want_statistics.bound) == "");
  CHECK(statistics.intact());
}

void check_history(Device& device, const History& shape, GemmBackend backend) {
  CAPTURE(shape.visible);
  CAPTURE(shape.order);
  CAPTURE(shape.windows);
  const Windows windows(device, shape);
  const MatrixF history = windows.host_rows();
  check_products(device, windows.device_rows(), history, shape.hidden, backend);

  const GuardedBlock gathered(device, shape.windows, static_cast<std::size_t>(history.cols()));
  gather(windows.device_rows(), gathered.rows());
  CHECK(gathered.values() == history);
  CHECK(gathered.intact());
}

/// The same moment of several sequences that lie one after another, or, with more frames than a
/// sequence has, rows that overlap.
void check_strided(Device& device, std::size_t sequences, std::size_t length, std::size_t columns,
                   std::size_t frames, GemmBackend backend) {
  CAPTURE(sequences);
  CAPTURE(columns);
  CAPTURE(frames);
  const MatrixF all = random_matrix(sequences * length + frames, columns, 4);
  const Matrix all_device = Matrix::from_host(device, all);
  const std::size_t width = frames == 1 ? columns : frames * all_device.stride();
  MatrixF rows =
      MatrixF::Zero(static_cast<Eigen::Index>(sequences), static_cast<Eigen::Index>(width));
  for (std::size_t s = 0; s < sequences; ++s)
    for (std::size_t q = 0; q < frames; ++q)
      rows.block(static_cast<Eigen::Index>(s), static_cast<Eigen::Index>(q * all_device.stride()),
                 1, static_cast<Eigen::Index>(columns)) =
          all.row(static_cast<Eigen::Index>(s * length + 1 + q));
  check_products(device, Rows::strided(all_device, 1, sequences, length, frames), rows, 5, backend);
}

void check_all_strided(GemmBackend backend) {
  on_every_device([=](Device& device) {
    check_strided(device, 3, 4, 5, 1, backend);
    check_strided(device, 7, 6, 17, 3, backend);
    check_strided(device, 5, 1, 17, 3, backend);
  });
}

}  // namespace

TEST_CASE("small: histories are read in place, by products, statistics and gather") {
  on_every_device([](Device& device) {
    for (const auto& shape : kSmallHistories) check_history(device, shape, GemmBackend::own);
  });
}

TEST_CASE("histories of five frames at the model's sizes, on both back ends") {
  on_every_device([](Device& device) {
    for (const auto& shape : kModelHistories) {
      check_history(device, shape, GemmBackend::own);
      check_history(device, shape, GemmBackend::clblast);
    }
  });
}

TEST_CASE("small: rows a step apart, one frame and several, rows that overlap") {
  check_all_strided(GemmBackend::own);
}

TEST_CASE("rows a step apart, and rows that overlap, which CLBlast does not take") {
  check_all_strided(GemmBackend::clblast);
}

TEST_CASE("small: results go to rows a step apart and leave those between alone") {
  on_every_device([](Device& device) {
    const MatrixF a = random_matrix(3, 5, 6), b = random_matrix(5, 7, 7);
    const MatrixF before = random_matrix(12, 7, 8);
    const Matrix a_device = Matrix::from_host(device, a), b_device = Matrix::from_host(device, b);
    const Matrix out = Matrix::from_host(device, before);
    gemm(a_device, b_device, Rows::strided(out, 2, 3, 4));
    const MatrixF after = out.to_host();
    const auto want = reference::product(a.cast<double>(), b.cast<double>());
    for (Eigen::Index r = 0; r < 12; ++r) {
      CAPTURE(r);
      if (r % 4 == 2)
        CHECK(misfit(after.row(r), want.value.row(r / 4), want.bound.row(r / 4)) == "");
      else
        CHECK(after.row(r) == before.row(r));
    }
    CHECK(padding_is_zero(out));
  });
}

TEST_CASE("small: scatter puts rows where an index points and leaves the others alone") {
  on_every_device([](Device& device) {
    const MatrixF rows = random_matrix(3, 17, 9), before = random_matrix(7, 17, 10);
    const Matrix out = Matrix::from_host(device, before);
    const IndexBuffer index(device, {9, 4, 0, 2});
    scatter(Matrix::from_host(device, rows), Rows::indexed(out, index, 1, 3, 1));
    MatrixF want = before;
    want.row(5) = rows.row(0);
    want.row(1) = rows.row(1);
    want.row(3) = rows.row(2);
    CHECK(out.to_host() == want);
  });
}

TEST_CASE("small: rows past the end of a matrix or an index are refused") {
  on_every_device([](Device& device) {
    const Matrix frames(device, 10, 3);
    const IndexBuffer index(device, {1, 2, 3});
    CHECK_THROWS_AS(Rows::indexed(frames, index, 1, 3), ShapeError);
    CHECK_THROWS_AS(Rows::strided(frames, 1, 3, 4, 2), ShapeError);
    CHECK_NOTHROW(Rows::strided(frames, 0, 3, 4, 2));
  });
}

}  // namespace gemm_rows_test
