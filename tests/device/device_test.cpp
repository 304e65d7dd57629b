#include "mcdbn/device/device.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "base/scoped_variable.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using test::ScopedVariable;

namespace {

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

bool same(const DeviceInfo& x, const DeviceInfo& y) {
  return x.platform_index == y.platform_index && x.device_index == y.device_index &&
         x.name == y.name;
}

std::string message_of(const DeviceSelection& selection) {
  try {
    Device::open(selection);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("small: every device is found by its indices") {
  const auto all = list_devices();
  REQUIRE(!all.empty());
  for (const auto& info : all) {
    const Device device =
        Device::open({std::to_string(info.platform_index), std::to_string(info.device_index)});
    CHECK(same(device.info(), info));
    CHECK(info.compute_units > 0);
    CHECK(info.global_memory_bytes > 0);
    CHECK(info.opencl_c_version.starts_with("OpenCL C "));
  }
}

TEST_CASE("small: a device is found by a part of its or its platform's name, in any case") {
  for (const auto& info : list_devices()) {
    const std::string part = info.name.substr(info.name.size() / 3);
    CHECK(upper(Device::open({"", upper(part)}).info().name).find(upper(part)) !=
          std::string::npos);
    CHECK(Device::open({upper(info.platform_name), ""}).info().platform_name == info.platform_name);
  }
}

TEST_CASE("small: what matches nothing is an error that lists every device") {
  const std::string message = message_of({"", "no such device"});
  CHECK(message.find("no such device") != std::string::npos);
  for (const auto& info : list_devices()) {
    CHECK(message.find(info.name) != std::string::npos);
    CHECK(message.find(info.platform_name) != std::string::npos);
  }
  // No index, and longer than any number in a name.
  const std::string number = "98765432123456789";
  CHECK(message_of({number, ""}).find("'" + number + "'") != std::string::npos);
  CHECK(message_of({"", number}).find("'" + number + "'") != std::string::npos);
}

TEST_CASE("a number is an index where there is one, else a part of a name") {
  const auto made_up = [](int platform, const char* platform_name, int index, const char* name) {
    DeviceInfo info;
    info.platform_index = platform;
    info.platform_name = platform_name;
    info.device_index = index;
    info.name = name;
    return info;
  };
  const std::vector<DeviceInfo> all{made_up(0, "CUDA 12", 0, "GeForce RTX 4090"),
                                    made_up(0, "CUDA 12", 1, "GeForce RTX 3070"),
                                    made_up(1, "Portable", 0, "cpu-avx512")};
  const auto names = [&](const DeviceSelection& selection) {
    std::vector<std::string> found;
    for (const DeviceInfo& info : matching_devices(all, selection)) found.push_back(info.name);
    return found;
  };
  using Names = std::vector<std::string>;
  CHECK(names({"", "4090"}) == Names{"GeForce RTX 4090"});
  CHECK(names({"", "512"}) == Names{"cpu-avx512"});
  CHECK(names({"12", "3070"}) == Names{"GeForce RTX 3070"});
  CHECK(names({"", "1"}) == Names{"GeForce RTX 3070"});  // not avx512
  CHECK(names({"1", ""}) == Names{"cpu-avx512"});        // not CUDA 12
  CHECK(names({"0", "0"}) == Names{"GeForce RTX 4090"});
  CHECK(names({"", ""}).size() == 3);
  CHECK(names({"", "5090"}).empty());
}

TEST_CASE("small: with nothing selected a GPU is taken where there is one") {
  const auto all = list_devices();
  const auto gpu =
      std::find_if(all.begin(), all.end(), [](const DeviceInfo& info) { return info.is_gpu; });
  CHECK(same(Device::open({}).info(), gpu != all.end() ? *gpu : all.front()));
}

TEST_CASE("small: the selection comes from the environment") {
  const ScopedVariable platform("MCDBN_PLATFORM", "first");
  const ScopedVariable device("MCDBN_DEVICE", "second");
  CHECK(DeviceSelection::from_environment().platform == "first");
  CHECK(DeviceSelection::from_environment().device == "second");
  CHECK_THROWS_AS(Device::open(), DeviceError);
}

TEST_CASE("small: without any device the text names what to install") {
  CHECK(describe_devices({}).find("pocl-opencl-icd") != std::string::npos);
}
