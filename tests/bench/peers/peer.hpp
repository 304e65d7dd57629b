#pragma once

// What the C++ peers share: the command line `PEER LAYER BATCH SECONDS`, the timing loop and the
// output. Each line of the input asks for one measurement of so many seconds, which is answered by
// a line, one JSON object {"variant": median_us}. The first line of the output is {}: ready.

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace peer {

constexpr std::size_t kFrames = 4096, kOrder = 5, kHidden = 300;
constexpr float kRate = 1e-3F, kRateA = 1e-5F, kMomentum = 0.9F, kDecay = 2e-4F;

struct Arguments {
  std::string layer;
  std::size_t batch;
  double seconds;
};

inline Arguments arguments(int argc, char** argv) {
  if (argc != 4) throw std::runtime_error("usage: PEER LAYER BATCH SECONDS");
  return {argv[1], std::stoul(argv[2]), std::stod(argv[3])};
}

inline std::vector<int> random_rows(std::size_t batch) {
  std::mt19937 generator(1);
  std::uniform_int_distribution<int> frame(kOrder, kFrames - 1);
  std::vector<int> rows(batch);
  for (int& row : rows) row = frame(generator);
  return rows;
}

/// Median microseconds of a step. `wait` returns when the steps so far are done.
inline double median_us(double seconds, const std::function<void()>& step,
                        const std::function<void()>& wait) {
  using Clock = std::chrono::steady_clock;
  const auto time_s = [&](std::size_t runs) {
    wait();
    const auto start = Clock::now();
    for (std::size_t i = 0; i < runs; ++i) step();
    wait();
    return std::chrono::duration<double>(Clock::now() - start).count() / static_cast<double>(runs);
  };
  step();
  const auto runs = static_cast<std::size_t>(std::clamp(0.01 / time_s(1), 1.0, 1000.0));
  std::vector<double> samples_us;
  const auto start = Clock::now();
  while (samples_us.size() < 5 || Clock::now() - start < std::chrono::duration<double>(seconds))
    samples_us.push_back(1e6 * time_s(runs));
  const auto middle = samples_us.begin() + static_cast<std::ptrdiff_t>(samples_us.size() / 2);
  std::nth_element(samples_us.begin(), middle, samples_us.end());
  return *middle;
}

inline void print(const std::string& variant, double median) {
  std::cout << "{\"" << variant << "\": " << median << "}" << std::endl;
}

/// Answers requests until the input ends.
inline void serve(const std::string& variant, double seconds, const std::function<void()>& step,
                  const std::function<void()>& wait) {
  step();
  wait();
  std::cout << "{}" << std::endl;
  for (std::string line; std::getline(std::cin, line);)
    print(variant, median_us(seconds, step, wait));
}

}  // namespace peer
