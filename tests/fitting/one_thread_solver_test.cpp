// What lies under the sparse solver keeps to one thread, and gets its threads back.

#include "fitting/one_thread_solver.hpp"

#include <dlfcn.h>
#include <doctest/doctest.h>

#include <atomic>
#include <optional>
#include <thread>

#include "fitting/loaded_function.hpp"

using namespace mcdbn;

namespace {

/// @return the number, or nothing where the library that has it is not loaded
std::optional<int> number(const char* function) {
  auto* const found = loaded_function<int()>(function);
  return found ? std::optional(found()) : std::nullopt;
}

}  // namespace

TEST_CASE("one thread: OpenMP and OpenBLAS have one while a solver is at work, then theirs again") {
  const auto levels = number("omp_get_max_active_levels");
  const auto threads = number("openblas_get_num_threads");
  REQUIRE(levels);  // CHOLMOD's own library needs it
  {
    const OneThreadSolver first;
    CHECK(number("omp_get_max_active_levels") == 0);
    if (threads) CHECK(number("openblas_get_num_threads") == 1);
  }
  CHECK(number("omp_get_max_active_levels") == levels);
  CHECK(number("openblas_get_num_threads") == threads);
}

TEST_CASE("one thread: solvers in two threads, and the first to end leaves the other its one") {
  const auto threads = number("openblas_get_num_threads");
  if (!threads || number("openblas_get_parallel") == 0) return;  // there they wait for each other
  std::optional<OneThreadSolver> first(std::in_place);
  std::atomic<bool> begun = false, end = false;
  std::thread other([&] {
    const OneThreadSolver second;
    begun = true;
    while (!end) std::this_thread::yield();
  });
  while (!begun) std::this_thread::yield();
  first.reset();
  CHECK(number("openblas_get_num_threads") == 1);
  end = true;
  other.join();
  CHECK(number("openblas_get_num_threads") == threads);
}

TEST_CASE("one thread: matrices are multiplied by the BLAS that the system has chosen") {
  void* const chosen = dlopen("libblas.so.3", RTLD_LAZY);
  REQUIRE(chosen);
  CHECK(dlsym(RTLD_DEFAULT, "dgemm_") == dlsym(chosen, "dgemm_"));
  dlclose(chosen);
}
