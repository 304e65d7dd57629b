#pragma once

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

namespace mcdbn::test {

/// Where the optional real data lies: $MCDBN_DATA, or shared/data beside the checkout.
inline std::filesystem::path shared_data() {
  if (const char* folder = std::getenv("MCDBN_DATA")) return folder;
  return std::filesystem::path(MCDBN_SOURCE_DIR) / ".." / "shared" / "data";
}

/// True if the file or folder is there; else reports by name which test is skipped.
inline bool have_shared_data(const std::string& relative, const char* test_name) {
  if (std::filesystem::exists(shared_data() / relative)) return true;
  std::cout << "SKIPPED " << test_name << ": no " << relative << " in the shared data folder\n";
  return false;
}

}  // namespace mcdbn::test
