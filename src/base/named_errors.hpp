#pragma once

#include <string>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

/// What `work` returns. The text of an InputError that it throws then begins with the input's name.
template <typename Work>
auto with_name(const std::string& name, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  }
}

}  // namespace mcdbn
