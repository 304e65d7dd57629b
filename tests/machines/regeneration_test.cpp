#include "mcdbn/machines/regeneration.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "machines/random_crbm.hpp"
#include "machines/regeneration_reference.hpp"
#include "machines/two_modalities.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/error_bounds.hpp"

namespace regeneration_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::misfit;

namespace {

constexpr std::size_t kTrack = 6, kPose = 9, kHidden = 7, kTop = 5, kShared = 4, kOrder = 2;

CrbmParameters layer(std::size_t visible, std::size_t hidden, VisibleKind kind, unsigned seed) {
  return random_layer(visible, hidden, kOrder, kind, seed);
}

/// A small MCDBN of two layers a modality, with parameters as after a training.
struct NetworkParameters : reference::Network {
  NetworkParameters() {
    track = {layer(kTrack, kHidden, VisibleKind::gaussian, 10),
             layer(kHidden, kTop, VisibleKind::binary, 20)};
    pose = {layer(kPose, kHidden, VisibleKind::gaussian, 30),
            layer(kHidden, kTop, VisibleKind::binary, 40)};
    mrbm = mrbm_of({random_matrix(kTop, kShared, 50, 2.0F), random_matrix(kTop, kShared, 51, 2.0F)},
                   {random_matrix(1, kTop, 52), random_matrix(1, kTop, 53)},
                   random_matrix(1, kShared, 54));
    look_ahead = 1;
    mean_field_steps = 3;
  }

  Mcdbn on(Device& device) const {
    Cdbn track_cdbn, pose_cdbn;
    for (const auto& p : track) track_cdbn.layers.emplace_back(device, p);
    for (const auto& p : pose) pose_cdbn.layers.emplace_back(device, p);
    return {{std::move(track_cdbn), std::move(pose_cdbn)},
            Mrbm(device, mrbm),
            look_ahead,
            mean_field_steps};
  }
};

RegenerationOptions options_with_run_in(std::size_t run_in) {
  RegenerationOptions options;
  options.run_in = run_in;
  return options;
}

}  // namespace

TEST_CASE("mean-field regeneration is Algorithm 3 in double, within the rounding bound") {
  for (const std::size_t look_ahead : {0U, 1U, 4U})
    for (const Eigen::Index frames : {1, 3, 13}) {
      NetworkParameters parameters;
      parameters.look_ahead = look_ahead;
      const MatrixF track = random_matrix(static_cast<std::size_t>(frames), kTrack, 7, 1.7F);
      const auto want = reference::regenerated(parameters, {track}, 1, 5, {}).front();
      REQUIRE(want.value.rows() == frames);
      on_every_device([&](Device& device) {
        const auto got = regenerate(parameters.on(device), {track}, options_with_run_in(5));
        REQUIRE(got.size() == 1);
        REQUIRE(got[0].rows() == frames);
        CHECK(want.bound.maxCoeff() < 1e-3);  // else the bound checks nothing
        CHECK(misfit(got[0], want.value, want.bound) == "");
      });
    }
}

TEST_CASE("clips that are regenerated together do not know of each other") {
  const NetworkParameters parameters;
  const MatrixF one = random_matrix(9, kTrack, 1), other = random_matrix(4, kTrack, 2);
  on_every_device([&](Device& device) {
    const Mcdbn network = parameters.on(device);
    const auto together = regenerate(network, {one, other});
    const auto alone = regenerate(network, {other});
    REQUIRE(together.size() == 2);
    CHECK(together[0].rows() == 9);
    CHECK(together[1].rows() == 4);
    CHECK((together[1] - alone[0]).cwiseAbs().maxCoeff() < 1e-5F);
  });
}

TEST_CASE("samples differ, the same seed gives the same ones, a low temperature the mean") {
  const NetworkParameters parameters;
  const MatrixF track = random_matrix(11, kTrack, 3);
  on_every_device([&](Device& device) {
    const Mcdbn network = parameters.on(device);
    RegenerationOptions options;
    options.samples = 3;
    options.temperature = 1.0;
    const auto samples = regenerate(network, {track}, options);
    REQUIRE(samples.size() == 3);
    CHECK((samples[0] - samples[1]).cwiseAbs().maxCoeff() > 1e-2F);
    CHECK((samples[1] - samples[2]).cwiseAbs().maxCoeff() > 1e-2F);
    CHECK(regenerate(network, {track}, options)[2] == samples[2]);
    options.seed = 2;
    CHECK(regenerate(network, {track}, options)[2] != samples[2]);

    options.temperature = 1e-6;
    const auto cold = regenerate(network, {track}, options);
    CHECK((cold[0] - cold[1]).cwiseAbs().maxCoeff() < 1e-4F);
  });
}

TEST_CASE(
    "with the MRBM's own Gibbs steps samples differ in the 3D code, without them they do not") {
  const NetworkParameters parameters;
  const MatrixF track = random_matrix(11, kTrack, 3), other = random_matrix(5, kTrack, 4);
  on_every_device([&](Device& device) {
    const Mcdbn network = parameters.on(device);
    const auto single = regenerate(network, {track, other});
    RegenerationOptions options;
    options.samples = 3;
    options.sampling.gibbs_steps = 0;  // the decoder draws nothing
    options.temperature = 1.0;
    const auto shared_code = regenerate(network, {track, other}, options);
    for (std::size_t i = 0; i < 6; ++i) CHECK(shared_code[i] == single[i / 3]);

    options.sampling.mrbm_gibbs_steps = parameters.mean_field_steps;
    const auto samples = regenerate(network, {track, other}, options);
    REQUIRE(samples.size() == 6);
    for (const std::size_t i : {0U, 1U, 3U, 4U})
      CHECK((samples[i] - samples[i + 1]).cwiseAbs().maxCoeff() > 1e-2F);
    CHECK(regenerate(network, {track, other}, options) == samples);
    // What follows in the batch changes nothing.
    const auto alone = regenerate(network, {track}, options);
    CHECK((alone[2] - samples[2]).cwiseAbs().maxCoeff() < 1e-5F);
    options.seed = 2;
    CHECK(regenerate(network, {track, other}, options)[2] != samples[2]);

    options.temperature = 1e-6;
    const auto cold = regenerate(network, {track, other}, options);
    for (std::size_t i = 0; i < 6; ++i)
      CHECK((cold[i] - single[i / 3]).cwiseAbs().maxCoeff() < 1e-4F);
    options.temperature = 0.0;
    CHECK(regenerate(network, {track, other}, options)[4] == single[1]);
  });
}

TEST_CASE("the start of a regeneration does not depend on the frames that follow the look-ahead") {
  NetworkParameters parameters;
  parameters.look_ahead = 2;
  MatrixF track = random_matrix(12, kTrack, 4);
  on_every_device([&](Device& device) {
    const Mcdbn network = parameters.on(device);
    const MatrixF before = regenerate(network, {track})[0];
    track.bottomRows(3).setConstant(3.0F);
    const MatrixF after = regenerate(network, {track})[0];
    CHECK(before.topRows(7) == after.topRows(7));  // frame t sees the track up to t + 2
    CHECK((before.row(7) - after.row(7)).cwiseAbs().maxCoeff() > 0.0F);
    track.bottomRows(3) = random_matrix(12, kTrack, 4).bottomRows(3);
  });
}

TEST_CASE("missing joints are filled in, and what is seen stays as it was") {
  const NetworkParameters parameters;
  const MatrixF track = random_matrix(10, kTrack, 5);
  MatrixF gappy = track;
  gappy.block(4, 2, 3, 2).setConstant(std::numeric_limits<float>::quiet_NaN());
  on_every_device([&](Device& device) {
    const Mcdbn network = parameters.on(device);
    const auto whole = regenerate(network, {track});
    const auto filled = regenerate(network, {gappy});
    CHECK(filled[0].allFinite());
    CHECK(filled[0].topRows(4 - 1) == whole[0].topRows(4 - 1));  // look-ahead 1
    CHECK((filled[0].row(4) - whole[0].row(4)).cwiseAbs().maxCoeff() > 0.0F);
    // Or left at the mean, where the network has learnt that.
    Mcdbn taught = parameters.on(device);
    taught.fills_gaps = false;
    MatrixF at_mean = track;
    at_mean.block(4, 2, 3, 2).setZero();
    CHECK(regenerate(taught, {gappy})[0] == regenerate(network, {at_mean})[0]);
  });
}

TEST_CASE("regenerate: nothing from nothing, and a track without frames is refused") {
  const NetworkParameters parameters;
  on_every_device([&](Device& device) {
    const Mcdbn network = parameters.on(device);
    CHECK(regenerate(network, {}).empty());
    CHECK_THROWS_AS(regenerate(network, {MatrixF(0, kTrack)}), ShapeError);
    CHECK_THROWS_AS(regenerate(network, {random_matrix(3, kTrack + 1, 1)}), ShapeError);
  });
}

TEST_CASE(
    "the reverse direction is the forward one of the network turned round, and look-ahead late") {
  constexpr std::size_t kLookAhead = 3;
  NetworkParameters parameters;
  parameters.look_ahead = kLookAhead;
  NetworkParameters turned;
  std::swap(turned.track, turned.pose);
  std::swap(turned.mrbm.W[0], turned.mrbm.W[1]);
  std::swap(turned.mrbm.a[0], turned.mrbm.a[1]);
  turned.look_ahead = 0;
  const MatrixF pose = random_matrix(13, kPose, 8, 1.3F);
  MatrixF late(pose.rows() + static_cast<Eigen::Index>(kLookAhead), pose.cols());
  late << pose.row(0).replicate(kLookAhead, 1), pose;
  on_every_device([&](Device& device) {
    const Mcdbn network = parameters.on(device), reversed = turned.on(device);
    for (const double temperature : {0.0, 1.0}) {
      RegenerationOptions options = options_with_run_in(5);
      options.samples = 2;
      options.temperature = temperature;
      const auto got = regenerate(network, {{}, {pose}}, 0, options);
      REQUIRE(got.size() == 2);
      REQUIRE(got[0].rows() == pose.rows());
      REQUIRE(got[0].cols() == static_cast<Eigen::Index>(kTrack));
      if (temperature > 0.0) {
        CHECK(got[0] != got[1]);
        continue;
      }
      const auto want = regenerate(reversed, std::vector<MatrixF>{late}, options);
      for (std::size_t i = 0; i < 2; ++i)
        CHECK((got[i] - want[i].topRows(pose.rows())).cwiseAbs().maxCoeff() < 1e-5F);
    }
  });
}

TEST_CASE("a third modality whose weights are zero changes nothing; wrong inputs are refused") {
  const NetworkParameters parameters;
  const MatrixF track = random_matrix(11, kTrack, 7), third = random_matrix(11, 4, 9);
  MrbmParameters three = parameters.mrbm;
  three.shape.modalities.push_back({"third", kTop});
  three.W.emplace_back(MatrixF::Zero(kTop, kShared));
  three.a.emplace_back(random_matrix(1, kTop, 10));
  const CrbmParameters own = layer(4, kTop, VisibleKind::gaussian, 60);
  on_every_device([&](Device& device) {
    const Mcdbn two = parameters.on(device);
    Mcdbn network = parameters.on(device);
    network.mrbm = Mrbm(device, three);
    network.cdbns.emplace_back().layers.emplace_back(device, own);
    const MatrixF want = single_answer(two, track);
    for (const auto& given : {std::vector<MatrixF>{}, std::vector<MatrixF>{third}}) {
      const MatrixF got = regenerate(network, {{track}, {}, given}, 1).front();
      CHECK((got - want).cwiseAbs().maxCoeff() < 1e-5F);
    }
    CHECK_THROWS_AS(regenerate(network, {{track}, {track}, {}}, 1), ShapeError);
    CHECK_THROWS_AS(regenerate(network, {{track}, {}}, 1), ShapeError);
    CHECK_THROWS_AS(regenerate(network, {{track}, {}, {third.topRows(5)}}, 1), ShapeError);
    CHECK_THROWS_AS(regenerate(network, {{track, track}, {}, {third}}, 1), ShapeError);
  });
}

}  // namespace regeneration_test
