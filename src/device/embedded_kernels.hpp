#pragma once

#include <map>
#include <string>

namespace mcdbn {

/// File name → text of everything in kernels/, as it was when the library was built.
const std::map<std::string, std::string>& embedded_kernels();

}  // namespace mcdbn
