#include "bench_tune.hpp"

#include <spdlog/spdlog.h>

#include <array>

#include "bench_steps.hpp"
#include "device/gemm.hpp"

namespace mcdbn::cli {
namespace {

/// A change must gain this much, or noise would decide.
constexpr double kWorthwhile = 0.97;

bool is_minibatch(const BenchStep& step) {
  const auto layer = step.what.at("layer").get<std::string>();
  return layer.ends_with("_crbm") && step.what.at("batch") == 100;
}

/// Seconds of a mini-batch of each kind of CRBM.
double minibatches_s(Device& device, const Tuning& tuning, double seconds) {
  device.set_tuning(tuning);
  double sum_s = 0;
  for (const BenchStepMaker& make : bench_steps()) {
    const BenchStep step = make(device);
    if (!is_minibatch(step)) continue;
    step.run();
    sum_s += median_time_s(device, step, seconds);
  }
  return sum_s;
}

Tuning fastest_tuning(Device& device, double seconds) {
  Tuning best = default_tuning(device.info());
  // The best so far is measured again beside each rival: a machine's speed drifts.
  for (const Tuning& rival : tuning_candidates(device.info(), best)) {
    if (rival == best) continue;
    // What differs from the default is carried over to the best so far.
    const Tuning base = default_tuning(device.info());
    Tuning merged = best;
    for (const auto parameter : {&Tuning::vector_width, &Tuning::largest_rows,
                                 &Tuning::accumulators, &Tuning::group, &Tuning::update_rows})
      if (rival.*parameter != base.*parameter) merged.*parameter = rival.*parameter;
    const double best_s = minibatches_s(device, best, seconds);
    const double merged_s = minibatches_s(device, merged, seconds);
    spdlog::info(
        "vector width {}, rows {}, accumulators {}, group {}, update rows {}: {:.2f} of "
        "the best so far",
        merged.vector_width, merged.largest_rows, merged.accumulators, merged.group,
        merged.update_rows, merged_s / best_s);
    if (merged_s < kWorthwhile * best_s) best = merged;
  }
  device.set_tuning(best);
  return best;
}

/// CLBlast's product within the rounding error of two float sums of k terms (Higham 3.5) of the
/// host's in double.
bool clblast_is_right(Device& device, Eigen::Index m, Eigen::Index n, Eigen::Index k) {
  const MatrixF a = MatrixF::Random(m, k), b = MatrixF::Random(k, n);
  Matrix c(device, static_cast<std::size_t>(m), static_cast<std::size_t>(n));
  GemmOptions options;
  options.backend = GemmBackend::clblast;
  gemm(Matrix::from_host(device, a), Matrix::from_host(device, b), c, options);
  const MatrixD want = a.cast<double>() * b.cast<double>();
  const MatrixD bound = static_cast<double>(k + 2) * 0x1p-24 *
                        (a.cwiseAbs().cast<double>() * b.cwiseAbs().cast<double>());
  return ((c.to_host().cast<double>() - want).cwiseAbs().array() <= bound.array()).all();
}

double product_s(Device& device, std::size_t size, GemmBackend backend, double seconds) {
  const Matrix a(device, size, size), b(device, size, size), c(device, size, size);
  GemmOptions options;
  options.backend = backend;
  const BenchStep step{{}, 0.0, [&] { gemm(a, b, c, options); }};
  step.run();
  return median_time_s(device, step, seconds);
}

/// The fewest multiply-adds from which CLBlast wins and is right; 0 if it never does.
std::int64_t clblast_threshold(Device& device, double seconds) {
  constexpr std::array<std::size_t, 3> kSizes{256, 512, 1024};
  for (const std::size_t size : kSizes) {
    const double own_s = product_s(device, size, GemmBackend::own, seconds);
    const double clblast_s = product_s(device, size, GemmBackend::clblast, seconds);
    spdlog::info("product of size {}: CLBlast takes {:.2f} of ours", size, clblast_s / own_s);
    if (clblast_s >= kWorthwhile * own_s) continue;
    const auto side = static_cast<Eigen::Index>(size);
    if (clblast_is_right(device, side, side, side) && clblast_is_right(device, side + 1, 33, side))
      return static_cast<std::int64_t>(size * size * size);
    spdlog::warn("CLBlast's product of size {} is wrong on {}; it stays unused", size,
                 device.info().name);
    return 0;
  }
  return 0;
}

}  // namespace

void tune(Device& device, double seconds) {
  Tuning best = fastest_tuning(device, seconds);
  best.clblast_from = clblast_threshold(device, seconds);
  device.set_tuning(best);
  store_tuning(device.info(), best);
}

}  // namespace mcdbn::cli
