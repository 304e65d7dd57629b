#pragma once

#include <mutex>

namespace mcdbn {

/// While it lives, what lies under Ceres' sparse solver works in the calling thread alone: CHOLMOD
/// and OpenBLAS would split loops that are too short over threads. Windows are solved two at once
/// instead. OpenBLAS of one thread (Debian's libopenblas0-serial) gives wrong factors when two
/// threads call it, so there one waits for the other. Neither library need be there: they are found
/// at run time, behind CHOLMOD.
class OneThreadSolver {
 public:
  OneThreadSolver();
  ~OneThreadSolver();
  OneThreadSolver(const OneThreadSolver&) = delete;
  OneThreadSolver& operator=(const OneThreadSolver&) = delete;

 private:
  int openmp_levels_ = 0;
  std::unique_lock<std::mutex> alone_;
};

}  // namespace mcdbn
