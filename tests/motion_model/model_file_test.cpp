#include "mcdbn/motion_model/model_file.hpp"

#include <doctest/doctest.h>

#include "base/scratch_folder.hpp"
#include "device/every_device.hpp"
#include "features/small_figure.hpp"
#include "machines/two_modalities.hpp"

namespace model_file_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("a model comes back from its file as it was saved") {
  const SmallFigure figure;
  const ScratchFolder folder;
  const auto path = folder / "model.safetensors";
  on_every_device([&](Device& device) {
    const auto layer = [&](std::size_t visible, VisibleKind kind, std::uint64_t seed) {
      return CrbmParameters::random({visible, 7, 2, kind}, 0.5, {seed, 0, 1, 0});
    };
    const auto track_units =
        static_cast<std::size_t>(figure.modalities().track_scale.output_dimension());
    const CrbmParameters track = layer(track_units, VisibleKind::gaussian, 1),
                         pose = layer(figure.dimension(), VisibleKind::gaussian, 2);
    const MrbmParameters mrbm = MrbmParameters::random(two_modalities(7, 7, 3), 0.5, {3, 0, 1, 0});
    Mcdbn network{std::vector<Cdbn>(2), Mrbm(device, mrbm), 4, 6};
    network.cdbns[0].layers.emplace_back(device, track);
    network.cdbns[1].layers.emplace_back(device, pose);
    network.deviation = AnswerDeviation{
        MatrixF::Constant(static_cast<Eigen::Index>(network.cdbns[1].code_dimension()),
                          static_cast<Eigen::Index>(network.cdbns[1].layers[0].shape().visible),
                          0.25F),
        MatrixF::Constant(1, static_cast<Eigen::Index>(network.cdbns[1].layers[0].shape().visible),
                          -1.5F)};
    network.sampling = {.gibbs_steps = 0, .mrbm_gibbs_steps = 3, .steady = true, .scale = 0.75};
    network.fills_gaps = false;
    save_model(path, {std::move(network),
                      figure.modalities(),
                      {{"a.bvh", "12"}},
                      {{"seed", 9}},
                      EarlyStopping{{"b.bvh", "c.bvh"}, 75, 0.25}});

    const Model model = load_model(device, path);
    CHECK(model.network.cdbns[0].layers[0].to_host().A == track.A);
    CHECK(model.network.cdbns[1].layers[0].to_host().B == pose.B);
    CHECK(model.network.mrbm.to_host().W[1] == mrbm.W[1]);
    CHECK(model.network.look_ahead == 4);
    CHECK(model.network.mean_field_steps == 6);
    REQUIRE(model.network.deviation);
    CHECK(model.network.deviation->C.isConstant(0.25F));
    CHECK(model.network.deviation->c.isConstant(-1.5F));
    CHECK(model.network.sampling.gibbs_steps == 0);
    CHECK(model.network.sampling.mrbm_gibbs_steps == 3);
    CHECK(model.network.sampling.steady);
    CHECK(model.network.sampling.scale == 0.75);
    CHECK_FALSE(model.network.fills_gaps);
    CHECK(model.modalities.pose_features.feature_names() ==
          figure.modalities().pose_features.feature_names());
    REQUIRE(model.training_clips.size() == 1);
    CHECK(model.training_clips[0].fingerprint == "12");
    CHECK(model.config.at("seed") == 9);
    REQUIRE(model.early_stopping);
    CHECK(model.early_stopping->held_out == std::vector<std::string>{"b.bvh", "c.bvh"});
    CHECK(model.early_stopping->steps == 75);
    CHECK(model.early_stopping->loss == 0.25);
  });
}

}  // namespace model_file_test
