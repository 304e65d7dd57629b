// Before the loader looks for layers, at the first OpenCL call.
#include <cstdlib>

namespace {

[[maybe_unused]] const int put_between = ::setenv("OPENCL_LAYERS", MCDBN_OPENCL_LAYER, 1);

}  // namespace
