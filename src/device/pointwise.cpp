#include "device/pointwise.hpp"

#include "device/gemm.hpp"
#include "device/kernel_arguments.hpp"

namespace mcdbn {
namespace {

/// One work-item for VEC columns of one row.
LaunchSize pointwise_size(const Rows& rows) {
  return {{ceil_divide(rows.columns, static_cast<std::size_t>(vector_width(rows.matrix->device()))),
           rows.count}};
}

cl::Kernel& units_kernel(Device& device, const char* name, Defines defines = {}) {
  defines["VEC"] = vector_width(device);
  return device.programs().kernel("pointwise.cl", name, defines);
}

}  // namespace

void apply_epilogue(const Rows& c, const GemmOptions& options) {
  Device& device = c.matrix->device();
  const Matrix& bias = options.bias ? *options.bias : *c.matrix;
  const Rows& factor = options.factor ? *options.factor : c;
  const Rows& sample = options.sample ? *options.sample : c;
  cl::Kernel& kernel = units_kernel(device, "epilogue", epilogue_defines(options));
  launch(device, kernel, pointwise_size(c), c.matrix->buffer(), c.offset(), c.stride(),
         to_int(c.columns), bias.buffer(), to_int(options.bias_first * bias.stride()),
         to_int(bias.stride()), factor.matrix->buffer(), factor.offset(), factor.stride(),
         sample.matrix->buffer(), sample.offset(), sample.stride(), options.temperature,
         options.kept_share, random_argument(options.random));
}

void gather(const Rows& rows, const Rows& out) {
  require(rows.index != nullptr && same_shape(rows, out),
          "gather: needs an index, and an output of its shape");
  Device& device = out.matrix->device();
  launch(device, units_kernel(device, "gather_rows"), pointwise_size(out), rows.matrix->buffer(),
         rows.stride(), rows.index->buffer(), to_int(rows.index_first), rows.shift,
         to_int(rows.columns), out.matrix->buffer(), out.offset(), out.stride());
}

void scatter(const Matrix& in, const Rows& out) {
  require(out.index != nullptr && same_shape(in, out),
          "scatter: needs an index, and an input of its shape");
  Device& device = in.device();
  launch(device, units_kernel(device, "scatter_rows"), pointwise_size(in), in.buffer(),
         Rows(in).stride(), out.matrix->buffer(), out.stride(), out.index->buffer(),
         to_int(out.index_first), out.shift, to_int(out.columns));
}

void gather_two(const Rows& x, const Rows& y, const Matrix& buffer, std::size_t first,
                std::size_t second) {
  const std::size_t x_stride = padded(x.columns), y_stride = padded(y.columns);
  require(x.index != nullptr && y.index != nullptr && x.count == y.count &&
              first + x.count * x_stride <= second &&
              second + y.count * y_stride <= buffer.element_count(),
          "gather: needs indices, and room for the rows");
  if (x.count == 0) return;
  Device& device = buffer.device();
  const std::size_t vectors =
      std::max(x_stride, y_stride) / static_cast<std::size_t>(vector_width(device));
  launch(device, units_kernel(device, "gather_two"), {{vectors, 2 * x.count}}, x.matrix->buffer(),
         x.stride(), x.index->buffer(), to_int(x.index_first), x.shift, y.matrix->buffer(),
         y.stride(), y.index->buffer(), to_int(y.index_first), y.shift, to_int(x.count),
         buffer.buffer(), to_int(first), to_int(x_stride), to_int(second), to_int(y_stride));
}

void scaled_difference(const Rows& x, const Rows& y, float scale, const Rows& out) {
  require(same_shape(x, y) && same_shape(x, out), "difference: shapes differ");
  Device& device = out.matrix->device();
  launch(device, units_kernel(device, "scaled_difference"), pointwise_size(out), x.matrix->buffer(),
         x.offset(), x.stride(), y.matrix->buffer(), y.offset(), y.stride(), to_int(out.columns),
         scale, out.matrix->buffer(), out.offset(), out.stride());
}

void scale_rows(const Rows& x, const Rows& weights, const Rows& out) {
  require(same_shape(x, out) && weights.count == x.count && weights.columns == 1,
          "scale: shapes differ");
  Device& device = out.matrix->device();
  launch(device, units_kernel(device, "scale_rows"), pointwise_size(out), x.matrix->buffer(),
         x.offset(), x.stride(), weights.matrix->buffer(), weights.offset(), weights.stride(),
         to_int(out.columns), out.matrix->buffer(), out.offset(), out.stride());
}

void scale_columns(const Rows& rows, const Matrix& factor, bool divides) {
  require(!rows.index && factor.rows() == 1 && factor.columns() == rows.columns,
          "scale_columns: shapes differ");
  Device& device = rows.matrix->device();
  launch(device, units_kernel(device, "scale_columns"), pointwise_size(rows), rows.matrix->buffer(),
         rows.offset(), rows.stride(), to_int(rows.columns), factor.buffer(), divides ? 1 : 0);
}

void multiply(const Rows& rows, const Rows& by) {
  require(!rows.index && !by.index && by.count == rows.count && by.columns == rows.columns,
          "multiply: shapes differ");
  Device& device = rows.matrix->device();
  launch(device, units_kernel(device, "multiply"), pointwise_size(rows), rows.matrix->buffer(),
         rows.offset(), rows.stride(), to_int(rows.columns), by.matrix->buffer(), by.offset(),
         by.stride());
}

void dropout(const Rows& c, float kept_share, const RandomKey& key, std::size_t alike) {
  require(kept_share > 0.0F && kept_share <= 1.0F, "dropout: the kept share is not in (0, 1]");
  require(alike > 0, "dropout: runs of no rows");
  Device& device = c.matrix->device();
  launch(device, units_kernel(device, "dropout", {{"SAMPLE", 1}}), pointwise_size(c),
         c.matrix->buffer(), c.offset(), c.stride(), to_int(c.columns), to_int(alike), kept_share,
         random_argument(key));
}

void transpose(const Matrix& in, Matrix& out) {
  require(in.rows() == out.columns() && in.columns() == out.rows(), "transpose: shapes differ");
  Device& device = out.device();
  const auto vec = static_cast<std::size_t>(vector_width(device));
  launch(device, units_kernel(device, "transpose"), {{in.columns(), ceil_divide(in.rows(), vec)}},
         in.buffer(), to_int(in.stride()), to_int(in.rows()), out.buffer(), to_int(out.stride()));
}

void transpose_lags(const Matrix& in, std::size_t lags, Matrix& out) {
  require(lags > 0 && in.rows() % lags == 0 && out.rows() == lags * padded(in.columns()) &&
              padded(out.columns()) == in.rows() / lags,
          "transpose_lags: shapes differ");
  Device& device = out.device();
  const auto vec = static_cast<std::size_t>(vector_width(device));
  launch(device, units_kernel(device, "transpose_lags"), {{in.columns(), in.rows() / vec}},
         in.buffer(), to_int(in.rows() / lags), to_int(in.stride()), out.buffer(),
         to_int(out.rows() / lags), to_int(out.stride()), to_int(lags));
}

void column_sum(const Rows& in, float scale, float beta, Matrix& out) {
  require(out.rows() == 1 && out.columns() == in.columns, "column_sum: shapes differ");
  Device& device = out.device();
  const LaunchSize size{
      {ceil_divide(in.columns, static_cast<std::size_t>(vector_width(device))), 1}};
  launch(device, units_kernel(device, "column_sum"), size, in.matrix->buffer(), in.offset(),
         in.stride(), to_int(in.count), to_int(in.columns), scale, beta, out.buffer());
}

void block_sum(const Matrix& in, const Rows& out) {
  require(out.first == 0 && out.columns == in.columns() && in.rows() % out.count == 0,
          "block_sum: shapes differ");
  Device& device = out.matrix->device();
  cl::Kernel& kernel =
      device.programs().kernel("reduce.cl", "block_sum", {{"VEC", vector_width(device)}});
  launch(device, kernel, pointwise_size(out), in.buffer(), to_int(in.stride()), to_int(out.count),
         to_int(in.rows() / out.count), to_int(out.columns), out.matrix->buffer(), out.stride());
}

}  // namespace mcdbn
