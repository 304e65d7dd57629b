#include "base/random_streams.hpp"

#include <doctest/doctest.h>

#include <map>
#include <regex>
#include <set>
#include <string>

#include "base/capture_bound.hpp"
#include "base/text_file.hpp"

namespace random_streams_test {

using namespace mcdbn;
using namespace mcdbn::random_streams;

namespace {

/// Every stream that the header names, so that none is left out here.
std::map<std::string, int> named_streams() {
  const std::string header =
      read_text_file(std::string(MCDBN_SOURCE_DIR) + "/src/base/random_streams.hpp");
  const std::regex constant(R"(constexpr std::uint16_t (k\w+)\s*=\s*(\w+);)");
  std::map<std::string, int> streams;
  for (std::sregex_iterator found(header.begin(), header.end(), constant), end; found != end;
       ++found)
    streams[(*found)[1]] = std::stoi((*found)[2], nullptr, 0);
  return streams;
}

/// Of a CDBN's layers, a perceptron's drop-out, an autoencoder's RBMs.
constexpr int kCdbnLayers = 64, kFurther = 16;

}  // namespace

TEST_CASE("random streams: no two are the same") {
  const std::map<std::string, int> streams = named_streams();
  REQUIRE(streams.size() >= 22);
  CHECK(streams.at("kMrbm") == kMrbm);
  CHECK(streams.at("kScalingViews") == kScalingViews);
  CHECK(streams.at("kBoltzmannMachine") == kBoltzmannMachine);
  std::set<int> taken;
  const auto take = [&](int first, int count) {
    for (int stream = first; stream < first + count; ++stream) {
      CAPTURE(stream);
      CHECK(taken.insert(stream).second);
    }
  };
  for (std::size_t cdbn = 0; cdbn < kMostModalities; ++cdbn) take(layers_of(cdbn), kCdbnLayers);
  for (const auto& [name, stream] : streams) {
    CAPTURE_BOUND(name);
    take(stream, stream == kPerceptron || stream == kAutoencoder ? kFurther : 1);
  }
}

}  // namespace random_streams_test
