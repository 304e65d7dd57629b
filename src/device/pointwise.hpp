#pragma once

#include "device/gemm.hpp"
#include "mcdbn/device/matrix.hpp"

namespace mcdbn {

/// Bias, activation and sampling of GemmOptions on values that are already in `c`.
void apply_epilogue(const Rows& c, const GemmOptions& options);
/// Copies indexed rows (history windows too) into consecutive ones. @param out [rows.count x
/// rows.columns]
void gather(const Rows& rows, const Rows& out);
/// The inverse: rows of `in` to the rows of a matrix that an index names.
void scatter(const Matrix& in, const Rows& out);

/// The rows of two matrices into `buffer` [1 x floats] in one launch, each row padded: those of x
/// from its float `first` on, those of y behind them from float `second` on. @throws ShapeError
void gather_two(const Rows& x, const Rows& y, const Matrix& buffer, std::size_t first,
                std::size_t second);
/// out = scale · (x − y), all of one shape, none indexed.
void scaled_difference(const Rows& x, const Rows& y, float scale, const Rows& out);
/// out = x with each row times its weight. @param weights [rows x 1]  @param x, out not indexed
void scale_rows(const Rows& x, const Rows& weights, const Rows& out);
/// Every row times `factor` [1 x columns], or divided by it; in place, not indexed.
void scale_columns(const Rows& rows, const Matrix& factor, bool divides = false);
/// Every entry times that of `by`, of the same shape; in place, neither indexed.
void multiply(const Rows& rows, const Rows& by);
/// Drop-out, in place: an entry is divided by `kept_share` with that probability, else zero.
/// @param alike runs of so many rows share their draws
void dropout(const Rows& c, float kept_share, const RandomKey& key, std::size_t alike = 1);
/// @param out [in.columns x in.rows]
void transpose(const Matrix& in, Matrix& out);
/// Weights from histories to frames become weights from the frames that follow: for each lag the
/// transposed block, the nearest frame first where `in` has the oldest first.
/// @param in [lags·padded(m) x n], padding zero  @param out [lags·padded(n) x m]
void transpose_lags(const Matrix& in, std::size_t lags, Matrix& out);
/// out = beta · out + scale · (sum over rows). @param out [1 x in.columns]
void column_sum(const Rows& in, float scale, float beta, Matrix& out);
/// out = sum of the blocks of out.count rows that make up `in`. @param in [blocks·rows x columns]
void block_sum(const Matrix& in, const Rows& out);

}  // namespace mcdbn
