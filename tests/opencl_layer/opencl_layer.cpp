// Programs that cannot call the layer set in the environment what is to happen:
//   MCDBN_LAYER_FAIL=clEnqueueNDRangeKernel,500,-2,lost   as fail()
//   MCDBN_LAYER_LIMITS=1,32768,1   as limit(): group, local bytes, vector width
//   MCDBN_LAYER_KERNELS=FILE       the kernels that run, one a line, with "in groups" where
//                                  work-items share one
#include "opencl_layer/opencl_layer.hpp"

#pragma GCC diagnostic ignored "-Wignored-attributes"
#include <CL/cl_layer.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>
#include <tuple>
#include <type_traits>

namespace mcdbn::test::layer {
namespace {

// Whatever a program calls that can fail, and what refers to objects.
#define MCDBN_CALLS(CALL)         \
  CALL(clGetPlatformIDs)          \
  CALL(clGetPlatformInfo)         \
  CALL(clGetDeviceIDs)            \
  CALL(clGetDeviceInfo)           \
  CALL(clCreateContext)           \
  CALL(clCreateCommandQueue)      \
  CALL(clCreateBuffer)            \
  CALL(clCreateSubBuffer)         \
  CALL(clCreateProgramWithSource) \
  CALL(clCreateProgramWithBinary) \
  CALL(clBuildProgram)            \
  CALL(clGetProgramInfo)          \
  CALL(clGetProgramBuildInfo)     \
  CALL(clCreateKernel)            \
  CALL(clSetKernelArg)            \
  CALL(clGetKernelInfo)           \
  CALL(clGetCommandQueueInfo)     \
  CALL(clGetEventProfilingInfo)   \
  CALL(clEnqueueNDRangeKernel)    \
  CALL(clEnqueueReadBuffer)       \
  CALL(clEnqueueWriteBuffer)      \
  CALL(clEnqueueCopyBuffer)       \
  CALL(clEnqueueFillBuffer)       \
  CALL(clFlush)                   \
  CALL(clFinish)                  \
  CALL(clRetainContext)           \
  CALL(clReleaseContext)          \
  CALL(clRetainCommandQueue)      \
  CALL(clReleaseCommandQueue)     \
  CALL(clRetainMemObject)         \
  CALL(clReleaseMemObject)        \
  CALL(clRetainProgram)           \
  CALL(clReleaseProgram)          \
  CALL(clRetainKernel)            \
  CALL(clReleaseKernel)           \
  CALL(clRetainEvent)             \
  CALL(clReleaseEvent)

struct Fault {
  std::size_t after = 0;
  cl_int code = CL_SUCCESS;
  bool loses_device = false, once = false;
};

struct State {
  std::mutex mutex;
  cl_icd_dispatch driver{}, table{};
  std::map<std::string, Fault> faults;
  cl_int lost = CL_SUCCESS;  ///< what every call fails with once the device is lost
  std::string build_log;
  std::map<std::string, std::size_t> calls;
  std::map<std::string, long> objects;
  std::size_t largest_buffer_bytes = 0;
  Limits limits;
  std::FILE* kernels_file = nullptr;
  std::set<std::string> kernels;  ///< lines of the file
};

/// Never destroyed: drivers call back while the process ends.
State& state() {
  static State& only = *new State;
  return only;
}

template <typename Object>
constexpr const char* kind_of() {
  if constexpr (std::is_same_v<Object, cl_context>) return "context";
  if constexpr (std::is_same_v<Object, cl_command_queue>) return "queue";
  if constexpr (std::is_same_v<Object, cl_mem>) return "buffer";
  if constexpr (std::is_same_v<Object, cl_program>) return "program";
  if constexpr (std::is_same_v<Object, cl_kernel>) return "kernel";
  if constexpr (std::is_same_v<Object, cl_event>) return "event";
  return nullptr;
}

bool starts_with(const char* name, const char* prefix) {
  return std::strncmp(name, prefix, std::strlen(prefix)) == 0;
}

/// Counts a call. @return what it fails with, if it is to fail
cl_int failure_of(const char* name) {
  State& all = state();
  const std::scoped_lock lock(all.mutex);
  const std::size_t before = all.calls[name]++;
  const bool works = starts_with(name, "clCreate") || starts_with(name, "clEnqueue") ||
                     starts_with(name, "clBuild") || starts_with(name, "clFinish");
  if (all.lost != CL_SUCCESS && works) return all.lost;
  const auto fault = all.faults.find(name);
  if (fault == all.faults.end() || before < fault->second.after) return CL_SUCCESS;
  const cl_int code = fault->second.code;
  if (fault->second.loses_device) all.lost = code;
  if (fault->second.once) all.faults.erase(fault);
  return code;
}

void count(const char* kind, long references) {
  State& all = state();
  const std::scoped_lock lock(all.mutex);
  all.objects[kind] += references;
}

/// What a call that went well has made, or given back.
template <typename Result, typename... Arguments>
void count_objects(const char* name, Result result, Arguments... arguments) {
  if constexpr (std::is_pointer_v<Result>) {
    if (result) count(kind_of<Result>(), 1);
  } else {
    using First = std::tuple_element_t<0, std::tuple<Arguments...>>;
    using Last = std::tuple_element_t<sizeof...(Arguments) - 1, std::tuple<Arguments...>>;
    if (result != CL_SUCCESS) return;
    if constexpr (kind_of<First>() != nullptr) {
      if (starts_with(name, "clRetain")) count(kind_of<First>(), 1);
      if (starts_with(name, "clRelease")) count(kind_of<First>(), -1);
    }
    if constexpr (std::is_same_v<Last, cl_event*>)
      if (std::get<sizeof...(Arguments) - 1>(std::tuple(arguments...)))
        count(kind_of<cl_event>(), 1);
  }
}

/// What stands between the program and one of the driver's calls.
template <typename Call>
struct Between;

template <typename Result, typename... Arguments>
struct Between<Result(CL_API_CALL*)(Arguments...)> {
  template <auto call, const char* name>
  static Result CL_API_CALL made(Arguments... arguments) {
    if (const cl_int code = failure_of(name); code != CL_SUCCESS) {
      if constexpr (std::is_pointer_v<Result>) {
        cl_int* error = std::get<sizeof...(Arguments) - 1>(std::tuple(arguments...));
        if (error) *error = code;
        return nullptr;
      } else {
        return code;
      }
    }
    const Result result = (state().driver.*call)(arguments...);
    count_objects(name, result, arguments...);
    return result;
  }
};

template <typename Number>
void lower(void* value, std::size_t size, Number most) {
  Number number{};
  if (!value || size < sizeof number) return;
  std::memcpy(&number, value, sizeof number);
  number = std::min(number, most);
  std::memcpy(value, &number, sizeof number);
}

constexpr char kDeviceInfo[] = "clGetDeviceInfo", kLaunch[] = "clEnqueueNDRangeKernel",
               kBuildInfo[] = "clGetProgramBuildInfo", kBuffer[] = "clCreateBuffer";

template <auto call, const char* name>
constexpr auto between =
    Between<std::remove_cvref_t<decltype(std::declval<cl_icd_dispatch>().*call)>>::template made<
        call, name>;

cl_int CL_API_CALL device_info(cl_device_id device, cl_device_info what, std::size_t size,
                               void* value, std::size_t* size_ret) {
  const cl_int code =
      between<&cl_icd_dispatch::clGetDeviceInfo, kDeviceInfo>(device, what, size, value, size_ret);
  if (code != CL_SUCCESS) return code;
  const Limits& limits = state().limits;
  if (what == CL_DEVICE_MAX_WORK_GROUP_SIZE) lower(value, size, limits.group);
  if (what == CL_DEVICE_LOCAL_MEM_SIZE) lower(value, size, cl_ulong{limits.local_bytes});
  if (what == CL_DEVICE_MAX_MEM_ALLOC_SIZE) lower(value, size, cl_ulong{limits.buffer_bytes});
  if (what == CL_DEVICE_PREFERRED_VECTOR_WIDTH_FLOAT || what == CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT)
    lower(value, size, cl_uint{limits.vector_width});
  return code;
}

/// As a device of these limits would refuse it.
cl_int refusal(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
               const std::size_t* group) {
  const State& all = state();
  std::size_t items = 1;
  for (cl_uint i = 0; group && i < dimensions; ++i) items *= group[i];
  if (items > all.limits.group) return CL_INVALID_WORK_GROUP_SIZE;
  cl_device_id device = nullptr;
  cl_ulong local_bytes = 0;
  all.driver.clGetCommandQueueInfo(queue, CL_QUEUE_DEVICE, sizeof device, &device, nullptr);
  all.driver.clGetKernelWorkGroupInfo(kernel, device, CL_KERNEL_LOCAL_MEM_SIZE, sizeof local_bytes,
                                      &local_bytes, nullptr);
  return local_bytes > all.limits.local_bytes ? CL_OUT_OF_RESOURCES : CL_SUCCESS;
}

void list_kernel(cl_kernel kernel, cl_uint dimensions, const std::size_t* group) {
  State& all = state();
  if (!all.kernels_file) return;
  std::array<char, 128> name{};
  all.driver.clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, name.size(), name.data(), nullptr);
  std::string line = name.data();
  for (cl_uint i = 0; group && i < dimensions; ++i)
    if (group[i] > 1) line = std::string(name.data()) + " in groups";
  const std::scoped_lock lock(all.mutex);
  if (!all.kernels.insert(line).second) return;
  std::fprintf(all.kernels_file, "%s\n", line.c_str());
  std::fflush(all.kernels_file);
}

cl_int CL_API_CALL launch(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                          const std::size_t* offset, const std::size_t* global,
                          const std::size_t* group, cl_uint waits, const cl_event* wait_for,
                          cl_event* event) {
  if (const cl_int code = refusal(queue, kernel, dimensions, group); code != CL_SUCCESS)
    return code;
  list_kernel(kernel, dimensions, group);
  return between<&cl_icd_dispatch::clEnqueueNDRangeKernel, kLaunch>(
      queue, kernel, dimensions, offset, global, group, waits, wait_for, event);
}

cl_mem CL_API_CALL create_buffer(cl_context context, cl_mem_flags flags, std::size_t bytes,
                                 void* values, cl_int* code) {
  {
    State& all = state();
    const std::scoped_lock lock(all.mutex);
    all.largest_buffer_bytes = std::max(all.largest_buffer_bytes, bytes);
    if (bytes > all.limits.buffer_bytes) {
      if (code) *code = CL_INVALID_BUFFER_SIZE;
      return nullptr;
    }
  }
  return between<&cl_icd_dispatch::clCreateBuffer, kBuffer>(context, flags, bytes, values, code);
}

cl_int CL_API_CALL build_info(cl_program program, cl_device_id device, cl_program_build_info what,
                              std::size_t size, void* value, std::size_t* size_ret) {
  const std::string log = state().build_log;
  if (what != CL_PROGRAM_BUILD_LOG || log.empty())
    return between<&cl_icd_dispatch::clGetProgramBuildInfo, kBuildInfo>(program, device, what, size,
                                                                        value, size_ret);
  if (size_ret) *size_ret = log.size() + 1;
  if (value) std::memcpy(value, log.c_str(), std::min(size, log.size() + 1));
  return CL_SUCCESS;
}

void read_environment() {
  if (const char* file = std::getenv("MCDBN_LAYER_KERNELS"))
    state().kernels_file = std::fopen(file, "w");
  if (const char* text = std::getenv("MCDBN_LAYER_FAIL")) {
    std::array<char, 64> call{}, rest{};
    std::size_t after = 0;
    int code = 0;
    if (std::sscanf(text, "%63[^,],%zu,%d,%63s", call.data(), &after, &code, rest.data()) >= 3)
      fail(call.data(), after, code, std::strcmp(rest.data(), "lost") == 0);
  }
  if (const char* text = std::getenv("MCDBN_LAYER_LIMITS")) {
    Limits limits;
    if (std::sscanf(text, "%zu,%lu,%u", &limits.group, &limits.local_bytes, &limits.vector_width) ==
        3)
      limit(limits);
  }
}

}  // namespace

void fail(const std::string& call, std::size_t after, int code, bool loses_device) {
  const std::scoped_lock lock(state().mutex);
  state().faults[call] = {after, code, loses_device, false};
}

void fail_once(const std::string& call, std::size_t after, int code) {
  const std::scoped_lock lock(state().mutex);
  state().faults[call] = {after, code, false, true};
}

void set_build_log(const std::string& text) {
  state().build_log = text;
}

void heal() {
  State& all = state();
  const std::scoped_lock lock(all.mutex);
  all.faults.clear();
  all.calls.clear();
  all.build_log.clear();
  all.largest_buffer_bytes = 0;
  all.lost = CL_SUCCESS;
}

std::map<std::string, std::size_t> calls() {
  const std::scoped_lock lock(state().mutex);
  return state().calls;
}

std::map<std::string, long> objects() {
  const std::scoped_lock lock(state().mutex);
  std::map<std::string, long> living = state().objects;
  std::erase_if(living, [](const auto& kind) { return kind.second == 0; });
  return living;
}

std::size_t largest_buffer_bytes() {
  const std::scoped_lock lock(state().mutex);
  return state().largest_buffer_bytes;
}

void limit(const Limits& limits) {
  state().limits = limits;
}

}  // namespace mcdbn::test::layer

extern "C" {

cl_int CL_API_CALL clGetLayerInfo(cl_layer_info what, std::size_t size, void* value,
                                  std::size_t* size_ret) {
  if (what != CL_LAYER_API_VERSION) return CL_INVALID_VALUE;
  const cl_layer_api_version version = CL_LAYER_API_VERSION_100;
  if (value && size >= sizeof version) std::memcpy(value, &version, sizeof version);
  if (size_ret) *size_ret = sizeof version;
  return CL_SUCCESS;
}

cl_int CL_API_CALL clInitLayer(cl_uint entries, const cl_icd_dispatch* driver, cl_uint* entries_ret,
                               const cl_icd_dispatch** table) {
  using namespace mcdbn::test::layer;
  constexpr cl_uint kEntries = sizeof(cl_icd_dispatch) / sizeof(void*);
  if (entries < kEntries) return CL_INVALID_VALUE;
  State& all = state();
  all.driver = all.table = *driver;
#define MCDBN_PUT_BETWEEN(NAME)                             \
  {                                                         \
    static constexpr char name[] = #NAME;                   \
    all.table.NAME = between<&cl_icd_dispatch::NAME, name>; \
  }
  MCDBN_CALLS(MCDBN_PUT_BETWEEN)
  all.table.clGetDeviceInfo = device_info;
  all.table.clEnqueueNDRangeKernel = launch;
  all.table.clGetProgramBuildInfo = build_info;
  all.table.clCreateBuffer = create_buffer;
  read_environment();
  *entries_ret = kEntries;
  *table = &all.table;
  return CL_SUCCESS;
}

}  // extern "C"
