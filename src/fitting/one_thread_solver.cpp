#include "fitting/one_thread_solver.hpp"

#include "fitting/loaded_function.hpp"

namespace mcdbn {
namespace {

struct SolverLibraries {
  // Levels of OpenMP are the calling thread's own; with none of them all loops run in it.
  int (*openmp_levels)() = loaded_function<int()>("omp_get_max_active_levels");
  void (*set_openmp_levels)(int) = loaded_function<void(int)>("omp_set_max_active_levels");
  int (*blas_parallel)() = loaded_function<int()>("openblas_get_parallel");
  int (*blas_threads)() = loaded_function<int()>("openblas_get_num_threads");
  void (*set_blas_threads)(int) = loaded_function<void(int)>("openblas_set_num_threads");

  bool has_openmp() const { return openmp_levels && set_openmp_levels; }
  bool has_openblas() const { return blas_parallel && blas_threads && set_blas_threads; }
};

const SolverLibraries& libraries() {
  static const SolverLibraries found;
  return found;
}

std::mutex one_at_a_time;
std::mutex counting;
int solvers = 0;       ///< that are at work; guarded by `counting`
int threads_else = 1;  ///< of OpenBLAS while none is; guarded by `counting`

/// OpenBLAS has one number of threads for all: the first solver sets it, the last sets it back.
void count_solver(int more) {
  const std::lock_guard guard(counting);
  if (solvers == 0) threads_else = libraries().blas_threads();
  solvers += more;
  libraries().set_blas_threads(solvers > 0 ? 1 : threads_else);
}

}  // namespace

OneThreadSolver::OneThreadSolver() {
  if (libraries().has_openmp()) {
    openmp_levels_ = libraries().openmp_levels();
    libraries().set_openmp_levels(0);
  }
  if (!libraries().has_openblas()) return;
  if (libraries().blas_parallel() == 0) alone_ = std::unique_lock(one_at_a_time);
  count_solver(1);
}

OneThreadSolver::~OneThreadSolver() {
  if (libraries().has_openblas()) count_solver(-1);
  if (libraries().has_openmp()) libraries().set_openmp_levels(openmp_levels_);
}

}  // namespace mcdbn
