#pragma once

#include <dlfcn.h>

namespace mcdbn {

/// A function of a library that may be loaded, or null.
template <typename Function>
Function* loaded_function(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace mcdbn
