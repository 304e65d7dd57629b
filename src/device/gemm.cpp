#include "device/gemm.hpp"

#include <clblast.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>

#include "device/kernel_arguments.hpp"
#include "device/opencl_errors.hpp"
#include "device/pointwise.hpp"

namespace mcdbn {
namespace {

/// Accumulator rows of one work-item: enough to hide the fma latency, few enough for the registers.
/// For few rows it is a power of two: each other number would be one more kernel to build.
int tile_rows_for(const Device& device, std::size_t rows) {
  return std::min(device.tuning().product_rows, to_int(std::bit_ceil(rows)));
}

/// One work-item a tile; on a CPU one a group, as a tile is work enough for a core.
LaunchSize tiles_of(const Rows& c, int width, int tile_rows) {
  LaunchSize size{{ceil_divide(c.columns, static_cast<std::size_t>(width)),
                   ceil_divide(c.count, static_cast<std::size_t>(tile_rows))}};
  if (c.matrix->device().tuning().group == 1) size.local = {1, 1};
  return size;
}

void require_operands(const Rows& a, const Rows& b, const Rows& c, const GemmOptions& options) {
  require(a.columns == b.count, "gemm: A's columns are not B's rows");
  require(b.columns == c.columns && a.count == c.count, "gemm: C's shape is not that of A·B");
  require(b.index == nullptr && c.index == nullptr, "gemm: only A may be indexed");
  if (options.bias)
    require(options.bias->columns() == c.columns &&
                (options.bias->rows() == 1 || options.bias_first + c.count <= options.bias->rows()),
            "gemm: the bias does not fit C");
  if (options.factor) require(same_shape(*options.factor, c), "gemm: the factor does not fit C");
  if (options.sample) require(same_shape(*options.sample, c), "gemm: the sample does not fit C");
  require((options.sampling == Sampling::none) == (options.sample == nullptr),
          "gemm: sampling needs a matrix for the draws, and the other way round");
  const bool is_gradient = options.activation == Activation::sigmoid_gradient ||
                           options.activation == Activation::relu_gradient ||
                           options.activation == Activation::centered_sigmoid_gradient;
  require(is_gradient == (options.factor != nullptr),
          "gemm: an activation's gradient needs its values, and the other way round");
}

/// Rows and columns of C of a work-item that keeps its columns of B in local memory (PACKED in
/// gemm.cl).
struct PackedGroup {
  std::size_t rows, columns;
};

/// Nothing where a work-item a tile does better: on a GPU, for few rows, where local memory is
/// short.
std::optional<PackedGroup> packed_group(const Device& device, const Rows& c, std::size_t k,
                                        std::size_t tile_rows, std::size_t width) {
  // Columns that leave room in a core's second cache; work for every unit, several times over.
  constexpr std::size_t kPackedBytes = 384 << 10, kLeastTiles = 16, kGroupsOfUnit = 8;
  const std::size_t row_tiles = ceil_divide(c.count, tile_rows);
  const std::size_t tile_bytes = k * width * sizeof(float);
  if (device.tuning().group != 1 || row_tiles < kLeastTiles || k == 0 ||
      tile_bytes > device.info().local_memory_bytes)
    return std::nullopt;
  const std::size_t units = std::max(1U, device.info().compute_units);
  const std::size_t bytes = std::min<std::size_t>(kPackedBytes, device.info().local_memory_bytes);
  const std::size_t most = std::max<std::size_t>(1, bytes / tile_bytes);
  const std::size_t panels = ceil_divide(ceil_divide(c.columns, width), most);
  const std::size_t columns = ceil_divide(ceil_divide(c.columns, width), panels) * width;
  const std::size_t groups = ceil_divide(units * kGroupsOfUnit, panels);
  return PackedGroup{std::max(kLeastTiles, ceil_divide(row_tiles, groups)) * tile_rows, columns};
}

void gemm_own(const Rows& a, const Rows& b, const Rows& c, const GemmOptions& options) {
  Device& device = c.matrix->device();
  const int vec = vector_width(device);
  const int tile_rows = tile_rows_for(device, c.count);
  Defines defines = epilogue_defines(options);
  defines["VEC"] = vec;
  defines["TILE_ROWS"] = tile_rows;
  const int columns = device.tuning().product_columns;
  defines["COLUMNS"] = columns;
  defines["A_ROWS"] = a.index ? 1 : 0;
  const auto width = static_cast<std::size_t>(columns) * static_cast<std::size_t>(vec);
  const auto group = packed_group(device, c, b.count, static_cast<std::size_t>(tile_rows), width);
  defines["PACKED"] = group ? 1 : 0;
  cl::Kernel& kernel = device.programs().kernel("gemm.cl", "gemm", defines);
  // Arguments that this variant does not read still need a buffer: C's own.
  const Matrix& bias = options.bias ? *options.bias : *c.matrix;
  const Rows& factor = options.factor ? *options.factor : c;
  const Rows& sample = options.sample ? *options.sample : c;
  const auto launch_with = [&](const LaunchSize& size, const auto&... more) {
    launch(device, kernel, size, a.matrix->buffer(), a.offset(), a.stride(),
           a.index ? a.index->buffer() : c.matrix->buffer(), to_int(a.index_first), a.shift,
           b.matrix->buffer(), b.offset(), b.stride(), c.matrix->buffer(), c.offset(), c.stride(),
           to_int(c.count), to_int(c.columns), to_int(b.count), options.alpha, options.beta,
           bias.buffer(), to_int(options.bias_first * bias.stride()), to_int(bias.stride()),
           factor.matrix->buffer(), factor.offset(), factor.stride(), sample.matrix->buffer(),
           sample.offset(), sample.stride(), options.temperature, options.kept_share,
           random_argument(options.random), more...);
  };
  if (!group) {
    launch_with(tiles_of(c, columns * vec, tile_rows));
    return;
  }
  launch_with({{ceil_divide(c.count, group->rows), ceil_divide(c.columns, group->columns)}, {1, 1}},
              to_int(group->rows), to_int(group->columns),
              cl::Local(b.count * group->columns * sizeof(float)));
}

/// Row-major product by CLBlast, which reads no index: indexed rows are gathered first.
void gemm_clblast(const Rows& a, const Rows& b, const Rows& c, float alpha, float beta,
                  clblast::Transpose transpose_a) {
  Device& device = c.matrix->device();
  Matrix gathered;
  const Rows* left = &a;
  Rows gathered_rows = a;
  if (a.index) {
    gathered = Matrix(device, a.count, a.columns);
    gathered_rows = Rows(gathered);
    gather(a, gathered_rows);
    left = &gathered_rows;
  }
  const std::size_t k = b.count;
  cl_command_queue queue = device.queue()();
  cl_event event = nullptr;  // of the last of its kernels
  const auto status = clblast::Gemm<float>(
      clblast::Layout::kRowMajor, transpose_a, clblast::Transpose::kNo, c.count, c.columns, k,
      alpha, left->matrix->buffer()(), static_cast<std::size_t>(left->offset()),
      static_cast<std::size_t>(left->stride()), b.matrix->buffer()(),
      static_cast<std::size_t>(b.offset()), static_cast<std::size_t>(b.stride()), beta,
      c.matrix->buffer()(), static_cast<std::size_t>(c.offset()),
      static_cast<std::size_t>(c.stride()), &queue, device.keeps_launch_times() ? &event : nullptr);
  if (status != clblast::StatusCode::kSuccess)
    throw DeviceError(fmt::format("{}: CLBlast's product: {}", device.info().name,
                                  opencl_failure(static_cast<cl_int>(status))),
                      kind_of_failure(static_cast<cl_int>(status)));
  if (event != nullptr) device.keep_launch("clblast_gemm", cl::Event(event));
  device.count_launch();
}

Rows rows_from(Rows rows, std::size_t first, std::size_t count) {
  rows.count = count;
  if (rows.index)
    rows.index_first += first;
  else
    rows.first += first * rows.step;
  return rows;
}

void add_transposed_a(const Rows& a, const Rows& b, const Rows& c, float alpha, float beta) {
  Device& device = c.matrix->device();
  const int vec = vector_width(device);
  const int tile_rows = device.tuning().transposed_rows;
  const int columns = device.tuning().transposed_columns;
  cl::Kernel& kernel = device.programs().kernel(
      "gemm.cl", "gemm_transposed_a",
      {{"VEC", vec}, {"TILE_ROWS", tile_rows}, {"COLUMNS", columns}, {"A_ROWS", a.index ? 1 : 0}});
  launch(device, kernel, tiles_of(c, columns * vec, tile_rows), a.matrix->buffer(), a.offset(),
         a.stride(), a.index ? a.index->buffer() : c.matrix->buffer(), to_int(a.index_first),
         a.shift, b.matrix->buffer(), b.offset(), b.stride(), c.matrix->buffer(), c.offset(),
         c.stride(), to_int(c.count), to_int(c.columns), to_int(b.count), alpha, beta);
}

/// Histories one frame apart: CLBlast takes no rows that overlap.
bool overlaps_itself(const Rows& a) {
  return a.index == nullptr && a.columns > static_cast<std::size_t>(a.stride());
}

bool goes_to_clblast(const Rows& a, const Rows& c, std::size_t k, GemmBackend backend) {
  if (k == 0 || backend == GemmBackend::own || overlaps_itself(a)) return false;
  if (backend == GemmBackend::clblast) return true;
  const std::int64_t from = c.matrix->device().tuning().clblast_from;
  return from > 0 && static_cast<std::int64_t>(c.count * c.columns * k) >= from;
}

/// The activation's name in epilogue.clh.
const char* name_of(Activation activation) {
  switch (activation) {
    case Activation::sigmoid:
      return "sigmoid";
    case Activation::sigmoid_gradient:
      return "sigmoid_gradient";
    case Activation::relu:
      return "relu";
    case Activation::relu_gradient:
      return "relu_gradient";
    case Activation::centered_sigmoid:
      return "centered_sigmoid";
    case Activation::centered_sigmoid_gradient:
      return "centered_sigmoid_gradient";
    default:
      return "none";
  }
}

}  // namespace

Defines epilogue_defines(const GemmOptions& options) {
  return {{"BIAS", !options.bias               ? "none"
                   : options.bias->rows() == 1 ? "row"
                                               : "matrix"},
          {"ACTIVATION", name_of(options.activation)},
          {"SAMPLE", static_cast<int>(options.sampling)}};
}

void gemm(const Rows& a, const Rows& b, const Rows& c, const GemmOptions& options) {
  require_operands(a, b, c, options);
  if (c.count == 0 || c.columns == 0) return;
  if (goes_to_clblast(a, c, b.count, options.backend)) {
    gemm_clblast(a, b, c, options.alpha, options.beta, clblast::Transpose::kNo);
    if (options.bias || options.activation != Activation::none ||
        options.sampling != Sampling::none)
      apply_epilogue(c, options);
    return;
  }
  gemm_own(a, b, c, options);
}

void gemm_transposed_a(const Rows& a, const Rows& b, const Rows& c, float alpha, float beta,
                       GemmBackend backend) {
  require(a.count == b.count, "gemm_transposed_a: A and B differ in rows");
  require(a.columns == c.count && b.columns == c.columns,
          "gemm_transposed_a: C's shape is not that of AᵀB");
  require(b.index == nullptr && c.index == nullptr, "gemm_transposed_a: only A may be indexed");
  if (c.count == 0 || c.columns == 0) return;
  if (goes_to_clblast(a, c, b.count, backend)) {
    gemm_clblast(a, b, c, alpha, beta, clblast::Transpose::kYes);
    return;
  }
  const auto summed = static_cast<std::size_t>(c.matrix->device().tuning().summed_rows);
  const std::size_t piece = summed > 0 ? summed : b.count;
  std::size_t first = 0;
  do {
    const std::size_t count = std::min(piece, b.count - first);
    add_transposed_a(rows_from(a, first, count), rows_from(b, first, count), c, alpha,
                     first == 0 ? beta : 1.0F);
    first += piece;
  } while (first < b.count);
}

}  // namespace mcdbn
