#include "device/program.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <sstream>

#include "base/scoped_variable.hpp"
#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "base/user_cache.hpp"
#include "device/every_device.hpp"
#include "device/launch.hpp"
#include "device/pointwise.hpp"
#include "mcdbn/base/errors.hpp"

namespace program_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

namespace fs = std::filesystem;

/// Opens the device anew, so that it has nothing in memory, and has it transpose a matrix.
bool works_afresh(const DeviceInfo& info) {
  Device device(info);
  const MatrixF in = random_matrix(3, 5, 1);
  Matrix out(device, 5, 3);
  transpose(Matrix::from_host(device, in), out);
  return out.to_host() == in.transpose();
}

/// The one number that a kernel writes.
cl_int answer_of(Device& device, cl::Kernel& kernel) {
  const cl::Buffer out(device.context(), CL_MEM_READ_WRITE, sizeof(cl_int));
  launch(device, kernel, {}, out);
  cl_int answer = 0;
  device.queue().enqueueReadBuffer(out, CL_TRUE, 0, sizeof answer, &answer);
  return answer;
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (fs::exists(folder))
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file()) files.push_back(entry.path());
  return files;
}

/// An entry whose checksum is right and whose binary is not.
std::string with_foreign_binary(const std::string& entry) {
  const std::string binary(5000, 'x');
  std::string magic, word, version, key;
  std::istringstream(entry) >> magic >> word >> version >> key;
  char header[128];
  std::snprintf(header, sizeof header, "%s %s %s %s %zu %016llx\n", magic.c_str(), word.c_str(),
                version.c_str(), key.c_str(), binary.size(),
                static_cast<unsigned long long>(fnv1a(binary)));
  return header + binary;
}

std::string error_text(const std::function<void()>& action) {
  try {
    action();
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("small: a program is cached as a binary, and a damaged entry is rebuilt silently") {
  on_every_device([](Device& open) {
    const ScratchFolder folder;
    const ScopedVariable cache("XDG_CACHE_HOME", (folder / "").string());
    const fs::path entries = folder / "mcdbn-cl";
    CHECK(works_afresh(open.info()));
    const auto files = files_in(entries);
    if (open.info().platform_name == "Portable Computing Language") {
      CHECK(files.empty());  // left to its own cache
      return;
    }
    REQUIRE(files.size() == 1);
    const fs::path file = files.front();
    const std::string good = read_text_file(file);
    const auto modified = fs::last_write_time(file);
    CHECK(works_afresh(open.info()));
    CHECK(fs::last_write_time(file) == modified);  // read, not built again

    std::string flipped = good;
    flipped[flipped.size() / 2] ^= 1;
    for (const std::string& bad :
         {std::string(), std::string("garbage"), good.substr(0, good.size() / 2), flipped,
          with_foreign_binary(good)}) {
      folder.write("mcdbn-cl/" + file.filename().string(), bad);
      CHECK(works_afresh(open.info()));
      CHECK(read_text_file(file) != bad);
      CHECK(read_text_file(file).size() > 1000);
    }
    CHECK(files_in(entries).size() == 1);
  });
}

TEST_CASE("small: a cache folder that cannot be written only costs time") {
  on_every_device([](Device& open) {
    const ScratchFolder folder;
    const ScopedVariable cache("XDG_CACHE_HOME", folder.write("file", "in the way").string());
    CHECK(works_afresh(open.info()));
    CHECK(read_text_file(folder / "file") == "in the way");
  });
}

TEST_CASE("small: cache entries come back whole, and only under their own kind and key") {
  const ScratchFolder folder;
  const ScopedVariable cache("XDG_CACHE_HOME", (folder / "").string());
  const std::string value("binary\0 and\nlines\n", 18);
  CHECK_FALSE(read_cache_entry("kind", "key").has_value());
  write_cache_entry("kind", "key", value);
  REQUIRE(read_cache_entry("kind", "key").has_value());
  CHECK(*read_cache_entry("kind", "key") == value);
  CHECK_FALSE(read_cache_entry("other", "key").has_value());
  CHECK_FALSE(read_cache_entry("kind", "other").has_value());
  write_cache_entry("kind", "key", "");
  REQUIRE(read_cache_entry("kind", "key").has_value());
  CHECK(read_cache_entry("kind", "key")->empty());
  CHECK(fnv1a("") == 0xcbf29ce484222325ULL);
  CHECK(fnv1a("foobar") == 0x85944171f73967e8ULL);  // published test vectors
}

TEST_CASE("small: kernels are read from MCDBN_KERNEL_DIR, with what they include") {
  on_every_device([](Device& open) {
    const ScratchFolder folder;
    folder.write("part.clh", "#define ANSWER 42\n");
    folder.write("probe.cl",
                 "#include \"part.clh\"\n"
                 "kernel void answer(global int* out) { out[0] = ANSWER + EXTRA; }\n");
    folder.write("broken.cl", "kernel void broken(global int* out) { out[0] = missing_name; }\n");
    const ScopedVariable kernels("MCDBN_KERNEL_DIR", (folder / "").string());
    const ScopedVariable cache("XDG_CACHE_HOME", (folder / "cache").string());
    Device device(open.info());
    CHECK(answer_of(device, device.programs().kernel("probe.cl", "answer", {{"EXTRA", 3}})) == 45);
    CHECK(device.launch_count() == 1);

    const auto kernel = [&](const char* file, const char* name) {
      return error_text([&] { device.programs().kernel(file, name); });
    };
    CHECK(kernel("absent.cl", "any").find("MCDBN_KERNEL_DIR") != std::string::npos);
    const std::string failure = kernel("broken.cl", "broken");
    CHECK(failure.find("missing_name") != std::string::npos);
    CHECK(failure.find('\n') == std::string::npos);
    const std::string before_log = "(the whole log: ";
    const auto log = failure.find(before_log);
    REQUIRE(log != std::string::npos);
    const std::string path = failure.substr(log + before_log.size());
    CHECK(read_text_file(path.substr(0, path.size() - 1)).find("missing_name") !=
          std::string::npos);
    std::filesystem::remove(path.substr(0, path.size() - 1));
    CHECK(error_text([&] {
            device.programs().kernel("probe.cl", "wrong_name", {{"EXTRA", 3}});
          }).find("wrong_name") != std::string::npos);
  });
}

TEST_CASE("small: builds and first launches with each size of groups count as compiling") {
  on_every_device([](Device& open) {
    const ScratchFolder folder;
    folder.write("probe.cl", "kernel void probe(global int* out) { out[get_global_id(0)] = 7; }\n");
    const ScopedVariable kernels("MCDBN_KERNEL_DIR", (folder / "").string());
    const ScopedVariable cache("XDG_CACHE_HOME", (folder / "cache").string());
    Device device(open.info());
    ProgramCache& programs = device.programs();
    const cl::Buffer out(device.context(), CL_MEM_READ_WRITE, 8 * sizeof(cl_int));
    CHECK(programs.compiling_s() == 0);
    cl::Kernel& kernel = programs.kernel("probe.cl", "probe");
    double before_s = 0;
    const auto grew = [&] {
      const bool more = programs.compiling_s() > before_s;
      before_s = programs.compiling_s();
      return more;
    };
    CHECK(grew());
    const auto launch_with = [&](std::size_t group) {
      launch(device, kernel, {.global = {8, 1}, .local = {group, 1}}, out);
    };
    launch_with(1);
    CHECK(grew());
    launch_with(1);
    CHECK_FALSE(grew());
    programs.kernel("probe.cl", "probe");
    CHECK_FALSE(grew());
    if (device.info().largest_group < 2) return;
    launch_with(2);
    CHECK(grew());
    launch_with(2);
    launch_with(1);
    CHECK_FALSE(grew());
  });
}

TEST_CASE("small: a kernel's first run is no part of the time that compiling takes") {
  using Clock = std::chrono::steady_clock;
  on_every_device([](Device& open) {
    const ScratchFolder folder;
    folder.write("probe.cl",
                 "kernel void probe(global float* out, int rounds) {\n"
                 "  float x = 1.0f;\n"
                 "  for (int i = 0; i < rounds; ++i) x = x * 0.5f + 1.0f;\n"
                 "  out[0] = x;\n"
                 "}\n");
    const ScopedVariable kernels("MCDBN_KERNEL_DIR", (folder / "").string());
    const ScopedVariable cache("XDG_CACHE_HOME", (folder / "cache").string());
    Device device(open.info());
    const cl::Buffer out(device.context(), CL_MEM_READ_WRITE, sizeof(cl_float));
    cl::Kernel& kernel = device.programs().kernel("probe.cl", "probe");
    const auto not_compiling_s = [&] {
      const double compiled_before_s = device.programs().compiling_s();
      const auto begin = Clock::now();
      launch(device, kernel, {.global = {1, 1}, .local = {1, 1}}, out, 20'000'000);
      device.finish();
      const std::chrono::duration<double> took = Clock::now() - begin;
      return took.count() - (device.programs().compiling_s() - compiled_before_s);
    };
    const double first_s = not_compiling_s();
    const double again_s = std::min({not_compiling_s(), not_compiling_s(), not_compiling_s()});
    CHECK(first_s > again_s / 2);
  });
}

TEST_CASE("small: long compiling is announced once, whatever was compiled before") {
  on_every_device([](Device& open) {
    Device device(open.info());
    int notices = 0;
    device.programs().count_compiling(5);
    device.programs().on_long_compiling([&] { ++notices; });
    device.programs().count_compiling(0.75);
    CHECK(notices == 0);
    device.programs().count_compiling(0.5);
    CHECK(notices == 1);
    device.programs().count_compiling(5);
    CHECK(notices == 1);
    CHECK(device.programs().compiling_s() == 11.25);
  });
}

TEST_CASE("small: kernels are built with the rounds to unroll that the device is tuned to") {
  on_every_device([](Device& open) {
    const ScratchFolder folder;
    folder.write("rounds.cl",
                 "#ifndef UNROLL\n#define UNROLL 1\n#endif\n"
                 "kernel void rounds(global int* out) { out[0] = UNROLL; }\n");
    const ScopedVariable kernels("MCDBN_KERNEL_DIR", (folder / "").string());
    const ScopedVariable cache("XDG_CACHE_HOME", (folder / "cache").string());
    const auto rounds = [](Device& device) {
      return answer_of(device, device.programs().kernel("rounds.cl", "rounds"));
    };
    Device device(open.info());
    CHECK(rounds(device) == device.tuning().unroll);
    for (const int unroll : {7, 1, 7}) {
      Tuning tuning = device.tuning();
      tuning.unroll = unroll;
      device.set_tuning(tuning);
      CHECK(rounds(device) == unroll);
    }
    Device gpu = as_gpu(open);
    CHECK(rounds(gpu) == default_tuning(gpu.info()).unroll);
    CHECK(gpu.tuning().unroll > 1);
  });
}

TEST_CASE("what the driver's compiler warns of is not written among our messages") {
  on_every_device([](Device& open) {
    const ScratchFolder folder;
    // Named after the process, so that no driver has it in its cache.
    folder.write("noisy.cl",
                 "int forgotten(int x) { if (x > 0) return 1; }\n"
                 "kernel void noisy(global int* out) { out[0] = forgotten(SALT); }\n");
    const ScopedVariable kernels("MCDBN_KERNEL_DIR", (folder / "").string());
    const ScopedVariable cache("XDG_CACHE_HOME", (folder / "cache").string());
    Device device(open.info());
    const int before = ::dup(STDERR_FILENO);
    const int file = ::open((folder / "stderr").c_str(), O_CREAT | O_WRONLY, 0600);
    REQUIRE(::dup2(file, STDERR_FILENO) == STDERR_FILENO);
    device.programs().kernel("noisy.cl", "noisy", {{"SALT", static_cast<int>(::getpid())}});
    ::dup2(before, STDERR_FILENO);
    ::close(before);
    ::close(file);
    CHECK(read_text_file(folder / "stderr") == "");
  });
}

TEST_CASE("small: the embedded kernels are those of the source folder") {
  const std::string folder = MCDBN_SOURCE_DIR "/kernels";
  int compared = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".cl") continue;
    const std::string file = entry.path().filename().string();
    CAPTURE(file);
    const std::string embedded = kernel_source(file);
    const ScopedVariable from_disk("MCDBN_KERNEL_DIR", folder);
    CHECK(embedded == kernel_source(file));
    CHECK(embedded.find("#include \"") == std::string::npos);
    ++compared;
  }
  CHECK(compared >= 4);
  CHECK_THROWS_AS(kernel_source("absent.cl"), DeviceError);
}

}  // namespace program_test
