#include "evaluation/method_names.hpp"

#include <doctest/doctest.h>

#include "evaluation/report_clip.hpp"

using namespace mcdbn;

TEST_CASE("method names: every method has a title, a place in a sentence, and one of its own") {
  for (const char* key :
       {"model", kMeanField, "mean_pose", "hold_last_frame", "nearest_neighbour", "ridge_window",
        "mlp_window", "bimodal_autoencoder", "multimodal_dbm", "twin_gaussian_process"}) {
    CAPTURE(key);
    const MethodName name = method_name(key);
    CHECK(name.key == key);
    CHECK_FALSE(name.title.empty());
    CHECK_FALSE(name.spoken.empty());
    CHECK(name.sentence.ends_with('.'));
    CHECK(name.sentence.find('_') == std::string_view::npos);
  }
  CHECK(method_name("mlp_window").title == "MLP");
  CHECK(method_name("mlp_window").spoken == "the MLP");
  CHECK(method_name("another").title == "another");
  CHECK(method_name("another").sentence.empty());
}
