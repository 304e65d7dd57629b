#include "evaluation/nelder_mead.hpp"

#include <algorithm>
#include <array>

namespace mcdbn {
namespace {

using Function = std::function<double(const Eigen::Vector3d&)>;

constexpr int kIterations = 1000;
constexpr int kRestarts = 10;
constexpr double kSmallestSimplex = 1e-9;
constexpr double kSmallestGain = 1e-9;

struct Vertex {
  Eigen::Vector3d at;
  double value = 0;
};

Vertex descend(const Function& function, const Vertex& start, double step) {
  const auto vertex = [&](const Eigen::Vector3d& at) { return Vertex{at, function(at)}; };
  std::array<Vertex, 4> simplex{start};
  for (int i = 0; i < 3; ++i)
    simplex[static_cast<std::size_t>(i) + 1] = vertex(start.at + step * Eigen::Vector3d::Unit(i));

  for (int iteration = 0; iteration < kIterations; ++iteration) {
    std::sort(simplex.begin(), simplex.end(),
              [](const Vertex& a, const Vertex& b) { return a.value < b.value; });
    const Vertex &best = simplex[0], &second_worst = simplex[2];
    Vertex& worst = simplex[3];
    if ((worst.at - best.at).norm() + (second_worst.at - best.at).norm() < kSmallestSimplex) break;

    const Eigen::Vector3d centre = (best.at + simplex[1].at + second_worst.at) / 3;
    const auto along = [&](double factor) { return vertex(centre + factor * (worst.at - centre)); };
    const Vertex reflected = along(-1);
    if (reflected.value < best.value) {
      const Vertex expanded = along(-2);
      worst = expanded.value < reflected.value ? expanded : reflected;
      continue;
    }
    if (reflected.value < second_worst.value) {
      worst = reflected;
      continue;
    }
    const Vertex contracted = along(reflected.value < worst.value ? -0.5 : 0.5);
    if (contracted.value < std::min(reflected.value, worst.value)) {
      worst = contracted;
      continue;
    }
    for (std::size_t i = 1; i < simplex.size(); ++i)
      simplex[i] = vertex(best.at + 0.5 * (simplex[i].at - best.at));
  }
  return *std::min_element(simplex.begin(), simplex.end(),
                           [](const Vertex& a, const Vertex& b) { return a.value < b.value; });
}

}  // namespace

Eigen::Vector3d nelder_mead(const Function& function, const Eigen::Vector3d& start, double step) {
  Vertex best{start, function(start)};
  for (int restart = 0; restart < kRestarts; ++restart) {
    const double before = best.value;
    best = descend(function, best, step);
    if (!(before - best.value > kSmallestGain)) break;
  }
  return best.at;
}

}  // namespace mcdbn
