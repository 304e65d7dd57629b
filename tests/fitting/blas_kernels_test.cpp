// OpenBLAS on a CPU that it does not know.

#include "fitting/blas_kernels.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>

#include "fitting/loaded_function.hpp"

// Column-major; c becomes alpha·a·b + beta·c.
extern "C" void dgemm_(const char* trans_a, const char* trans_b, const int* m, const int* n,
                       const int* k, const double* alpha, const double* a, const int* lda,
                       const double* b, const int* ldb, const double* beta, double* c,
                       const int* ldc);

namespace blas_kernels_test {

using namespace mcdbn;

namespace {

constexpr const char* kVariable = "OPENBLAS_CORETYPE";

/// @return whose kernels are called, or nothing with another BLAS or an OpenBLAS of one CPU
std::optional<std::string> kernels() {
  const auto name = loaded_function<char*()>("openblas_get_corename");
  if (!name || !loaded_function<void()>("gotoblas_dynamic_init")) return {};
  return name();
}

/// Chooses anew, as when the library is loaded with the variable set to that.
void choose_as_loaded(const char* cpu) {
  setenv(kVariable, cpu, 1);
  loaded_function<void()>("gotoblas_dynamic_quit")();
  loaded_function<void()>("gotoblas_dynamic_init")();
  unsetenv(kVariable);
}

/// The largest error of a product of odd size, in units of what n additions and products may lose.
double product_error() {
  constexpr int kRows = 37, kInner = 53, kColumns = 41;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(kRows, kInner),
                        b = Eigen::MatrixXd::Random(kInner, kColumns);
  Eigen::MatrixXd c(kRows, kColumns);
  const double one = 1, zero = 0;
  dgemm_("N", "N", &kRows, &kColumns, &kInner, &one, a.data(), &kRows, b.data(), &kInner, &zero,
         c.data(), &kRows);
  const Eigen::MatrixXd magnitude = a.cwiseAbs().lazyProduct(b.cwiseAbs());
  const double unit = kInner * std::numeric_limits<double>::epsilon();
  return ((c - a.lazyProduct(b)).array().abs() / (unit * magnitude.array())).maxCoeff();
}

}  // namespace

TEST_CASE("BLAS kernels: a Pentium 4's give way to those of the CPU's instructions") {
  const auto found = kernels();
  if (!found) return;
  const std::string like(known_cpu_like_this());
  choose_as_loaded("Prescott");
  REQUIRE(kernels() == "Prescott");
  choose_blas_kernels();
  CHECK(kernels() == (like.empty() ? "Prescott" : like));
  CHECK(std::getenv(kVariable) == nullptr);
  CHECK(product_error() <= 1);
  choose_as_loaded(found->c_str());
}

TEST_CASE("BLAS kernels: what the variable names, or OpenBLAS knows, stays") {
  const auto found = kernels();
  if (!found) return;
  choose_as_loaded("Prescott");
  setenv(kVariable, "Prescott", 1);
  choose_blas_kernels();
  CHECK(kernels() == "Prescott");
  unsetenv(kVariable);
  choose_as_loaded("Nehalem");
  choose_blas_kernels();
  CHECK(kernels() == "Nehalem");
  choose_as_loaded(found->c_str());
}

}  // namespace blas_kernels_test
