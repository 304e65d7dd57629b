#include "fitting/blas_kernels.hpp"

#include <cstdlib>
#include <string>

#include "fitting/loaded_function.hpp"

namespace mcdbn {
namespace {

constexpr const char* kVariable = "OPENBLAS_CORETYPE";
/// What OpenBLAS calls the kernels that every x86-64 CPU can run.
constexpr std::string_view kOldest = "Prescott";

}  // namespace

std::string_view known_cpu_like_this() {
#if defined(__x86_64__)
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
                      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  if (avx512) return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return {};
}

void choose_blas_kernels() {
  const auto chosen = loaded_function<char*()>("openblas_get_corename");
  const auto forget = loaded_function<void()>("gotoblas_dynamic_quit");
  const auto choose = loaded_function<void()>("gotoblas_dynamic_init");
  if (!chosen || !forget || !choose || std::getenv(kVariable) || chosen() != kOldest) return;
  const std::string_view like = known_cpu_like_this();
  if (like.empty()) return;
  setenv(kVariable, std::string(like).c_str(), 1);
  forget();
  choose();
  unsetenv(kVariable);
}

}  // namespace mcdbn
