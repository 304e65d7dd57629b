#include "device/tuner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "base/upper_median.hpp"
#include "device/default_tuning.hpp"
#include "device/gemm.hpp"
#include "device/median_time.hpp"
#include "device/peak.hpp"
#include "device/tuning_fields.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/device/matrix.hpp"

namespace mcdbn {
namespace {

/// A change must gain this much, or noise would decide.
constexpr double kWorthwhile = 0.97;

/// `to` with what `from` has otherwise than the default.
Tuning with_changes(Tuning to, const Tuning& from, const Tuning& usual) {
  for (const auto& [name, value] : kTuningFields)
    if (from.*value != usual.*value) to.*value = from.*value;
  return to;
}

/// The values that differ from the default: "vector width 8, group 64".
std::string described(const Tuning& tuning, const Tuning& usual) {
  std::string text;
  for (const auto& [name, value] : kTuningFields)
    if (tuning.*value != usual.*value)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, tuning.*value);
  std::ranges::replace(text, '_', ' ');
  return text.empty() ? "the default" : text;
}

/// The values that only products depend on (gemm.cpp).
auto product_parameters(const Tuning& tuning) {
  return std::tie(tuning.product_rows, tuning.product_columns, tuning.transposed_rows,
                  tuning.transposed_columns, tuning.summed_rows);
}

/// The rival's time as a share of the best's: the median over pairs measured side by side, as a
/// machine's speed drifts and one noisy run must not decide.
double paired_ratio(const TunedTime& time_s, const Tuning& rival, const Tuning& best) {
  std::vector<double> ratios(5);
  for (double& ratio : ratios) {
    const double best_s = time_s(best);
    ratio = time_s(rival) / best_s;
  }
  return upper_median(std::move(ratios));
}

/// CLBlast's products, A·B and Aᵀ·B, within the rounding error of two float sums of k terms (Higham
/// 3.5) of the host's in double.
bool clblast_is_right(Device& device, Eigen::Index m, Eigen::Index n, Eigen::Index k) {
  const MatrixF a = MatrixF::Random(m, k), b = MatrixF::Random(k, n);
  const MatrixD want = a.cast<double>() * b.cast<double>();
  const MatrixD bound = static_cast<double>(k + 2) * 0x1p-24 *
                        (a.cwiseAbs().cast<double>() * b.cwiseAbs().cast<double>());
  const Matrix right = Matrix::from_host(device, b);
  Matrix c(device, static_cast<std::size_t>(m), static_cast<std::size_t>(n));
  const auto is_right = [&] {
    return ((c.to_host().cast<double>() - want).cwiseAbs().array() <= bound.array()).all();
  };
  GemmOptions options;
  options.backend = GemmBackend::clblast;
  gemm(Matrix::from_host(device, a), right, c, options);
  if (!is_right()) return false;
  gemm_transposed_a(Matrix::from_host(device, MatrixF(a.transpose())), right, c, 1.0F, 0.0F,
                    GemmBackend::clblast);
  return is_right();
}

double product_s(Device& device, std::size_t size, GemmBackend backend, double seconds) {
  const Matrix a(device, size, size), b(device, size, size);
  Matrix c(device, size, size);
  GemmOptions options;
  options.backend = backend;
  const auto run = [&] { gemm(a, b, c, options); };
  run();
  return median_time_s(device, run, seconds);
}

/// clblast_threshold() where the device takes CLBlast's groups.
/// @throws DeviceError where a product fails
std::int64_t measured_threshold(Device& device, double seconds, const TuningNotice& notice) {
  // From above the products of a mini-batch of 100 windows to above those of one of 1024.
  constexpr std::array<std::size_t, 3> kSizes{256, 512, 1024};
  for (const std::size_t size : kSizes) {
    const double own_s = product_s(device, size, GemmBackend::own, seconds);
    const double clblast_s = product_s(device, size, GemmBackend::clblast, seconds);
    if (notice)
      notice(
          fmt::format("product of size {}: CLBlast takes {:.2f} of ours", size, clblast_s / own_s));
    if (clblast_s >= kWorthwhile * own_s) continue;
    // Larger products than that go to CLBlast, too, where it may take another kernel.
    bool right = true;
    for (std::size_t checked = size; right && checked <= kSizes.back(); checked *= 2) {
      const auto side = static_cast<Eigen::Index>(checked);
      right = clblast_is_right(device, side, side, side) &&
              clblast_is_right(device, side + 1, 33, side);
    }
    if (right) return static_cast<std::int64_t>(size * size * size);
    if (notice)
      notice(fmt::format("CLBlast's products from size {} on are wrong on {}; it stays unused",
                         size, device.info().name));
    return 0;
  }
  return 0;
}

}  // namespace

Tuning tuning_for_units(Device& device, const TuningNotice& notice) {
  const Tuning usual = default_tuning(device.info());
  if (device.info().is_gpu || usual.vector_width < 16) return usual;
  const bool is_full = has_units_of_16_floats(device);
  if (notice) notice(fmt::format("units of {} bits", is_full ? 512 : 256));
  return is_full ? usual : for_units_of_8_floats(usual);
}

Tuning fastest_tuning(const DeviceInfo& info, const Tuning& usual, const TunedWork& work,
                      const TuningNotice& notice) {
  Tuning best = usual;
  for (const Tuning& rival : tuning_candidates(info, usual)) {
    if (rival == usual) continue;
    const Tuning merged = with_changes(best, rival, usual);
    const bool of_products = product_parameters(rival) != product_parameters(usual);
    const double ratio =
        paired_ratio(of_products ? work.products_s : work.minibatches_s, merged, best);
    if (notice)
      notice(fmt::format("{}: {:.2f} of the best so far", described(merged, usual), ratio));
    if (ratio < kWorthwhile) best = merged;
  }
  return best;
}

std::int64_t clblast_threshold(Device& device, double seconds, const TuningNotice& notice) {
  Tuning with_clblast = device.tuning();
  with_clblast.clblast_from = 1;
  if (limited(with_clblast, device.info()).clblast_from == 0) return 0;  // its groups are too large
  try {
    return measured_threshold(device, seconds, notice);
  } catch (const DeviceError& error) {
    if (error.kind() == DeviceError::Kind::no_device) throw;
    if (notice) notice(fmt::format("{}; CLBlast stays unused", error.what()));
    return 0;
  }
}

bool tune(Device& device, const Tuning& usual, const TunedWork& work, double seconds,
          const TuningNotice& notice) {
  const auto on_device = [&](const TunedTime& time_s) {
    return [&device, time_s](const Tuning& tuning) {
      device.set_tuning(tuning);
      return time_s(tuning);
    };
  };
  Tuning best = fastest_tuning(
      device.info(), usual,
      {.products_s = on_device(work.products_s), .minibatches_s = on_device(work.minibatches_s)},
      notice);
  device.set_tuning(best);
  best.clblast_from = clblast_threshold(device, seconds, notice);
  device.set_tuning(best);
  return store_tuning(device.info(), best);
}

}  // namespace mcdbn
