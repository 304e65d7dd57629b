// A model is the same in every tensor and every field after it was saved and loaded.

#include <doctest/doctest.h>

#include "base/safetensors.hpp"
#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion_model/example_model.hpp"

namespace model_round_trip_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

void check_layers(const std::vector<Crbm>& got, const std::vector<CrbmParameters>& want) {
  REQUIRE(got.size() == want.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    CAPTURE(i);
    const CrbmParameters layer = got[i].to_host();
    CHECK(layer.shape == want[i].shape);
    CHECK(got[i].shape() == want[i].shape);
    CHECK(layer.W == want[i].W);
    CHECK(layer.A == want[i].A);
    CHECK(layer.B == want[i].B);
    CHECK(layer.a == want[i].a);
    CHECK(layer.b == want[i].b);
    CHECK(layer.visible_mean == want[i].visible_mean);
    CHECK(layer.visible_deviation == want[i].visible_deviation);
    CHECK(got[i].W_transposed.to_host() == want[i].W.transpose());
  }
}

void check_mrbm(const MrbmParameters& got, const MrbmParameters& want) {
  for (std::size_t m = 0; m < 2; ++m) {
    CAPTURE(m);
    CHECK(got.W[m] == want.W[m]);
    CHECK(got.a[m] == want.a[m]);
  }
  CHECK(got.b == want.b);
}

void check_scale(const Standardizer& got, const Standardizer& want) {
  CHECK(got.mean() == want.mean());
  CHECK(got.deviation() == want.deviation());
  CHECK(got.kept_columns() == want.kept_columns());
  CHECK(got.input_dimension() == want.input_dimension());
}

void check_modalities(const Modalities& got, const Modalities& want) {
  CHECK(got.pose_features.feature_names() == want.pose_features.feature_names());
  CHECK(got.pose_features.joints() == want.pose_features.joints());
  CHECK(got.pose_features.root() == want.pose_features.root());
  CHECK(got.pose_features.fixed_channels() == want.pose_features.fixed_channels());
  CHECK(bvh_header_text(got.pose_features.skeleton()) ==
        bvh_header_text(want.pose_features.skeleton()));
  CHECK(got.root_name() == want.root_name());
  CHECK(got.track_features.joint_names() == want.track_features.joint_names());
  CHECK(got.track_features.root_name() == want.track_features.root_name());
  check_scale(got.pose_scale, want.pose_scale);
  check_scale(got.track_scale, want.track_scale);
  CHECK(got.fps == want.fps);
  CHECK(got.camera == want.camera);
}

void check_same(const Model& got, const Model& want, const ExampleModel& example) {
  check_layers(got.network.cdbns[0].layers, example.track);
  check_layers(got.network.cdbns[1].layers, example.pose);
  check_mrbm(got.network.mrbm.to_host(), example.mrbm);
  CHECK(got.network.look_ahead == want.network.look_ahead);
  CHECK(got.network.mean_field_steps == want.network.mean_field_steps);
  CHECK(got.network.sampling.gibbs_steps == want.network.sampling.gibbs_steps);
  CHECK(got.network.sampling.mrbm_gibbs_steps == want.network.sampling.mrbm_gibbs_steps);
  CHECK(got.network.sampling.steady == want.network.sampling.steady);
  CHECK(got.network.sampling.sampled == want.network.sampling.sampled);
  CHECK(got.network.sampling.scale == want.network.sampling.scale);
  CHECK(got.network.fills_gaps == want.network.fills_gaps);
  check_modalities(got.modalities, want.modalities);
  REQUIRE(got.training_clips.size() == want.training_clips.size());
  for (std::size_t i = 0; i < got.training_clips.size(); ++i) {
    CHECK(got.training_clips[i].path == want.training_clips[i].path);
    CHECK(got.training_clips[i].fingerprint == want.training_clips[i].fingerprint);
    CHECK(got.training_clips[i].person == want.training_clips[i].person);
    CHECK(got.training_clips[i].action == want.training_clips[i].action);
  }
  CHECK(got.config == want.config);
  REQUIRE(got.early_stopping.has_value() == want.early_stopping.has_value());
  if (!want.early_stopping) return;
  CHECK(got.early_stopping->held_out == want.early_stopping->held_out);
  CHECK(got.early_stopping->steps == want.early_stopping->steps);
  CHECK(got.early_stopping->loss == want.early_stopping->loss);
}

/// The file's tensor of that name is the matrix.
void check_tensor(const Safetensors& file, const std::string& name, const MatrixF& want) {
  CAPTURE(name);
  REQUIRE(file.tensors.count(name) == 1);
  CHECK(file.get(name, "", want.rows(), want.cols()) == want);
}

}  // namespace

TEST_CASE("a model is equal in every tensor and field after saving and loading") {
  const ScratchFolder folder;
  for (const bool equal_sizes : {false, true}) {
    CAPTURE(equal_sizes);
    const ExampleModel example(equal_sizes);
    on_every_device([&](Device& device) {
      const Model model = example.on(device);
      save_model(folder / "one", model);
      check_same(load_model(device, folder / "one"), model, example);
      // Saved again it is the same file.
      save_model(folder / "two", load_model(device, folder / "one"));
      CHECK(read_text_file(folder / "one") == read_text_file(folder / "two"));
    });
  }
}

TEST_CASE("what a model may lack is lacking after saving and loading, and other values come too") {
  const ScratchFolder folder;
  const ExampleModel example(false);
  on_every_device([&](Device& device) {
    Model model = example.on(device);
    model.early_stopping.reset();
    model.training_clips.clear();
    model.config = nlohmann::json::object();
    model.modalities.camera.distance.reset();
    model.network.fills_gaps = true;
    model.network.look_ahead = 0;
    model.network.mean_field_steps = 1;
    model.network.sampling = {.gibbs_steps = 0, .mrbm_gibbs_steps = 0, .steady = false, .scale = 2};
    save_model(folder / "one", model);
    check_same(load_model(device, folder / "one"), model, example);
  });
}

TEST_CASE("histories of A's and B's own, and a learnt deviation, are saved and loaded") {
  const ScratchFolder folder;
  const ExampleModel example(false);
  on_every_device([&](Device& device) {
    Model model = example.on(device);
    std::vector<CrbmParameters> stack = example.track;
    CrbmShape shape = stack[0].shape;
    shape.own_order_A = 1;
    stack[0].A = stack[0].A.bottomRows(static_cast<Eigen::Index>(shape.visible)).eval();
    stack[0].visible_deviation = random_matrix(1, shape.visible, 3).cwiseAbs();
    stack[0].shape = shape;
    shape = stack[1].shape;
    shape.own_order_B = 0;
    stack[1].B = stack[1].B.topRows(0).eval();
    stack[1].shape = shape;
    model.network.cdbns[0].layers.clear();
    for (const CrbmParameters& p : stack) model.network.cdbns[0].layers.emplace_back(device, p);
    save_model(folder / "one", model);
    const Model loaded = load_model(device, folder / "one");
    check_layers(loaded.network.cdbns[0].layers, stack);
    check_layers(loaded.network.cdbns[1].layers, example.pose);
  });
}

TEST_CASE("every tensor stands under its own name in the file") {
  const ScratchFolder folder;
  const ExampleModel example(true);
  on_every_device([&](Device& device) {
    save_model(folder / "one", example.on(device));
    const Safetensors file = read_safetensors(folder / "one");
    CHECK(file.tensors.size() == 6 * (example.track.size() + example.pose.size()) + 5);
    for (const auto& [name, layers] :
         {std::pair{"track.", &example.track}, std::pair{"pose.", &example.pose}})
      for (std::size_t i = 0; i < layers->size(); ++i) {
        const std::string prefix = name + std::to_string(i) + ".";
        const CrbmParameters& p = (*layers)[i];
        check_tensor(file, prefix + "W", p.W);
        check_tensor(file, prefix + "A", p.A);
        check_tensor(file, prefix + "B", p.B);
        check_tensor(file, prefix + "a", p.a);
        check_tensor(file, prefix + "b", p.b);
        check_tensor(file, prefix + "visible_mean", p.visible_mean);
      }
    check_tensor(file, "mrbm.W_track", example.mrbm.W[0]);
    check_tensor(file, "mrbm.W_pose", example.mrbm.W[1]);
    check_tensor(file, "mrbm.a_track", example.mrbm.a[0]);
    check_tensor(file, "mrbm.a_pose", example.mrbm.a[1]);
    check_tensor(file, "mrbm.b", example.mrbm.b);
  });
}

TEST_CASE("a model is written as a whole: who has the old file open keeps it") {
  const ScratchFolder folder;
  const ExampleModel example(true);
  on_every_device([&](Device& device) {
    Model model = example.on(device);
    save_model(folder / "one", model);
    const std::string before = read_text_file(folder / "one");
    std::filesystem::remove(folder / "old");
    std::filesystem::create_hard_link(folder / "one", folder / "old");
    model.network.look_ahead = 9;
    save_model(folder / "one", model);
    CHECK(read_text_file(folder / "old") == before);
    CHECK(load_model(device, folder / "one").network.look_ahead == 9);
  });
}

TEST_CASE("a model that was saved before some fields came has their defaults") {
  const ScratchFolder folder;
  const ExampleModel example(false);
  on_every_device([&](Device& device) {
    save_model(folder / "one", example.on(device));
    Safetensors file = read_safetensors(folder / "one");
    auto about = nlohmann::json::parse(file.metadata.at("mcdbn"));
    for (const char* name : {"sampling", "fills_gaps", "early_stopping"})
      REQUIRE(about.erase(name) == 1);
    file.metadata["mcdbn"] = about.dump();
    write_safetensors(folder / "one", file);
    const Model model = load_model(device, folder / "one");
    CHECK(model.network.fills_gaps);
    CHECK(model.network.sampling.gibbs_steps == 1);
    CHECK(model.network.sampling.mrbm_gibbs_steps == 0);
    CHECK_FALSE(model.network.sampling.steady);
    CHECK(model.network.sampling.scale == 1.0);
    CHECK_FALSE(model.early_stopping);
  });
}

TEST_CASE("a training clip is known by its absolute path and by its bytes") {
  const ScratchFolder folder;
  const auto one = folder.write("one.bvh", "a");
  std::filesystem::create_directory(folder / "sub");
  const auto copy = folder.write("sub/copy.bvh", "a"), other = folder.write("other.bvh", "b");
  CHECK(identify_clip(one).fingerprint == identify_clip(copy).fingerprint);
  CHECK(identify_clip(one).fingerprint != identify_clip(other).fingerprint);
  CHECK(identify_clip(one).fingerprint == "af63dc4c8601ec8c");  // FNV-1a of "a", as published
  CHECK(identify_clip(folder.write("nothing.bvh", "")).fingerprint == "cbf29ce484222325");
  CHECK(identify_clip(folder / "sub/../one.bvh").path == one.string());
  CHECK(identify_clip(std::filesystem::relative(one)).path == one.string());
  CHECK_THROWS_AS(identify_clip(folder / "missing.bvh"), InputError);
}

}  // namespace model_round_trip_test
