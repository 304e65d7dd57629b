// Programs that a driver does not build.
#include <doctest/doctest.h>

#include <filesystem>

#include "base/text_file.hpp"
#include "device/program.hpp"
#include "device_faults/tiny_training.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// A device that has built nothing yet builds a program.
std::string failure() {
  Device device = Device::open();
  try {
    device.programs().kernel("pointwise.cl", "transpose", {{"VEC", 4}});
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

std::size_t builds() {
  const auto calls = layer::calls();
  const auto found = calls.find("clBuildProgram");
  return found == calls.end() ? 0 : found->second;
}

/// The file that the message names, once. @return what it holds
std::string kept_log(const std::string& message) {
  const std::string before = "(the whole log: ";
  const auto at = message.find(before);
  REQUIRE(at != std::string::npos);
  REQUIRE(message.back() == ')');
  const std::string path =
      message.substr(at + before.size(), message.size() - 1 - at - before.size());
  CHECK(message.find(path) == message.rfind(path));
  const std::string log = read_text_file(path);
  std::filesystem::remove(path);
  return log;
}

}  // namespace

TEST_CASE("a build that fails with an error is not tried again; its whole log is kept") {
  const HealthyDriver driver;
  layer::fail("clBuildProgram", 0, CL_BUILD_PROGRAM_FAILURE);
  const std::string log = "a warning\nfile.cl:3: error: no such name\nand much more\n";
  layer::set_build_log(log);
  const std::string message = failure();
  CAPTURE(message);
  CHECK(builds() == 1);
  CHECK(message.find("file.cl:3: error: no such name (the whole log: ") != std::string::npos);
  CHECK(message.find('\n') == std::string::npos);
  CHECK(kept_log(message) == log);
}

TEST_CASE("a build that fails without an error is tried once more, and only once") {
  const HealthyDriver driver;
  layer::set_build_log("\nnothing wrong here\n");
  layer::fail_once("clBuildProgram", 0, CL_BUILD_PROGRAM_FAILURE);
  CHECK(failure().empty());
  CHECK(builds() == 2);

  layer::heal();
  layer::set_build_log("\nnothing wrong here\n");
  layer::fail("clBuildProgram", 0, CL_BUILD_PROGRAM_FAILURE);
  const std::string message = failure();
  CAPTURE(message);
  CHECK(builds() == 2);
  // PoCL's log when its cache is on a full disk has no error in it either.
  CHECK(message.find("reports only 'nothing wrong here'; is there room where it keeps") !=
        std::string::npos);
  kept_log(message);

  layer::heal();
  layer::set_build_log(" \n");
  layer::fail("clBuildProgram", 0, CL_BUILD_PROGRAM_FAILURE);
  CHECK(failure().find("gives no reason; is there room") != std::string::npos);
}

TEST_CASE("two builds that fail keep two logs") {
  const HealthyDriver driver;
  layer::fail("clBuildProgram", 0, CL_BUILD_PROGRAM_FAILURE);
  layer::set_build_log("error one");
  const std::string one = failure();
  layer::set_build_log("error two");
  const std::string two = failure();
  CHECK(kept_log(one).starts_with("error one"));
  CHECK(kept_log(two).starts_with("error two"));
}

TEST_CASE("a device that is lost while it builds is reported as lost, not for what its log lacks") {
  const HealthyDriver driver;
  layer::fail("clBuildProgram", 0, CL_DEVICE_NOT_AVAILABLE, true);
  const std::string message = failure();
  CAPTURE(message);
  CHECK(message.find("the device is lost") != std::string::npos);
  CHECK(message.find("transpose") != std::string::npos);
  CHECK(builds() == 1);
}
