#include "comparison/baseline.hpp"

#include <doctest/doctest.h>

#include "clips.hpp"
#include "comparison/bimodal_autoencoder.hpp"
#include "comparison/constant_pose.hpp"
#include "comparison/hold_last_frame.hpp"
#include "comparison/mlp_window.hpp"
#include "comparison/multimodal_dbm.hpp"
#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

namespace {

/// One of each, those that train made small.
std::vector<std::unique_ptr<Baseline>> small_baselines(Device& device) {
  MlpWindow::Settings mlp;
  mlp.hidden = 8;
  BimodalAutoencoderSettings autoencoder;
  autoencoder.track_hidden = autoencoder.pose_hidden = autoencoder.shared = 8;
  MultimodalDbmSettings dbm;
  dbm.track_hidden = dbm.pose_hidden = dbm.joint = 8;
  dbm.inference_steps = 3;
  mlp.epochs = autoencoder.epochs = autoencoder.pretraining_epochs = dbm.epochs =
      dbm.pretraining_epochs = 1;
  mlp.least_batches = autoencoder.least_batches = dbm.least_batches = 2;
  std::vector<std::unique_ptr<Baseline>> all;
  for (const std::string& name : all_baselines())
    if (name == "mlp_window")
      all.push_back(std::make_unique<MlpWindow>(device, mlp));
    else if (name == "bimodal_autoencoder")
      all.push_back(std::make_unique<BimodalAutoencoder>(device, autoencoder));
    else if (name == "multimodal_dbm")
      all.push_back(std::make_unique<MultimodalDbm>(device, dbm));
    else
      all.push_back(make_baseline(name, device, false));
  return all;
}

}  // namespace

TEST_CASE("baselines have names, by which they are made") {
  const std::vector<std::string> usual = {"mean_pose", "hold_last_frame", "nearest_neighbour",
                                          "ridge_window", "mlp_window"};
  std::vector<std::string> all = usual;
  all.insert(all.end(), {"bimodal_autoencoder", "multimodal_dbm", "twin_gaussian_process"});
  CHECK(usual_baselines() == usual);
  CHECK(all_baselines() == all);
  test::on_every_device([&](Device& device) {
    for (const std::string& name : all) {
      const auto baseline = make_baseline(name, device, false);
      CHECK(baseline->name() == name);
      CHECK(baseline->learns_from_views() == (name == "mlp_window"));
    }
    CHECK_THROWS_AS(make_baseline("mean", device, false), ConfigError);
  });
}

TEST_CASE("baselines_of: words that mean several, names, each once and in the report's order") {
  CHECK(baselines_of({"usual"}) == usual_baselines());
  CHECK(baselines_of({"all"}) == all_baselines());
  CHECK(baselines_of({"none"}).empty());
  CHECK(baselines_of({}).empty());
  CHECK(baselines_of({"multimodal_dbm", "mean_pose", "multimodal_dbm"}) ==
        std::vector<std::string>{"mean_pose", "multimodal_dbm"});
  CHECK(baselines_of({"usual", "mean_pose", "twin_gaussian_process"}).size() == 6);
  try {
    baselines_of({"mean_pose", "ridge"});
    FAIL("not refused");
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    CHECK(text.find("'ridge'") != std::string::npos);
    CHECK(text.find("twin_gaussian_process") != std::string::npos);
  }
}

TEST_CASE("every baseline: shapes, missing joints and misuse") {
  const std::vector<MatrixF> tracks = {test::random_clip(14, 3, 1), test::random_clip(9, 3, 2)};
  const std::vector<MatrixF> poses = {test::random_clip(14, 5, 3), test::random_clip(9, 5, 4)};
  test::on_every_device([&](Device& device) {
    for (const auto& baseline : small_baselines(device)) {
      CAPTURE(baseline->name());
      CHECK_THROWS_AS(baseline->predict(tracks[0]), ShapeError);
      CHECK_THROWS_AS(baseline->fit(tracks, {poses[0]}), ShapeError);
      CHECK_THROWS_AS(baseline->fit(tracks, {poses[1], poses[0]}), ShapeError);
      CHECK_THROWS_AS(baseline->fit({}, {}), ShapeError);
      baseline->fit(tracks, poses);
      CHECK_THROWS_AS(baseline->predict(test::random_clip(4, 2, 5)), ShapeError);

      MatrixF unseen = test::random_clip(21, 3, 6), zeroed = unseen;
      unseen(4, 1) = unseen(20, 2) = NAN;
      zeroed(4, 1) = zeroed(20, 2) = 0;
      const MatrixF pose = baseline->predict(unseen);
      CHECK(pose.rows() == 21);
      CHECK(pose.cols() == 5);
      CHECK(pose.allFinite());
      CHECK(pose == baseline->predict(zeroed));

      // The same in training.
      std::vector<MatrixF> gappy = tracks, filled = tracks;
      gappy[1](3, 0) = NAN;
      filled[1](3, 0) = 0;
      baseline->fit(gappy, poses);
      const MatrixF from_gappy = baseline->predict(zeroed);
      baseline->fit(filled, poses);
      CHECK(from_gappy == baseline->predict(zeroed));
      CHECK(baseline->predict(MatrixF(0, 3)).rows() == 0);
      CHECK(baseline->predict(MatrixF(0, 3)).cols() == 5);
    }
  });
}

TEST_CASE("mean_pose weighs frames, not clips") {
  ConstantPose baseline;
  baseline.fit({MatrixF::Zero(1, 2), MatrixF::Zero(3, 2)},
               {MatrixF::Constant(1, 1, 8), MatrixF::Constant(3, 1, 4)});
  CHECK(baseline.predict(MatrixF::Ones(2, 2)) == MatrixF::Constant(2, 1, 5));
}

TEST_CASE("hold_last_frame holds the nearest neighbour of the first frame") {
  const std::vector<MatrixF> tracks = {test::random_clip(14, 3, 1)};
  const std::vector<MatrixF> poses = {test::random_clip(14, 5, 3)};
  HoldLastFrame baseline;
  baseline.fit(tracks, poses);
  CHECK(baseline.predict(tracks[0].bottomRows(4)) == poses[0].row(10).replicate(4, 1));
}

}  // namespace mcdbn
