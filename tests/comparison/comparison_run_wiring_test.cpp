// What a test run shows to whom, and what it scores.

#include <doctest/doctest.h>

#include "comparison/baseline.hpp"
#include "comparison/clip_files.hpp"
#include "comparison/comparison_run.hpp"
#include "comparison/mlp_window.hpp"
#include "comparison/report_clips.hpp"
#include "device/every_device.hpp"
#include "fitting/track_smoothing.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion_model/clip_scene.hpp"

namespace comparison_run_wiring_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr double kFps = 30;

/// Two clips that a model was trained on, three to test it on, all in files.
struct Scene : ClipFiles {
  CameraPlacement test_view{-50, 5, std::nullopt, 40, 1280, 720};

  Scene()
      : ClipFiles({{"08_01.bvh", paced_clip(14, 1.0)}, {"walk_s02_01.bvh", paced_clip(9, 1.4)}},
                  {{"08_02.bvh", paced_clip(21, 1.2)},
                   {"09_01.bvh", paced_clip(12, 0.8)},
                   {"jump_s02_07.bvh", paced_clip(17, 1.1)}},
                  {35, 12, std::nullopt, 45, 1920, 1080}) {}
};

TestRunOptions plain_options(const Scene& scene) {
  TestRunOptions options;
  options.camera = scene.test_view;
  options.baselines.clear();
  options.fit.reset();
  options.regeneration.run_in = 4;
  return options;
}

/// What a tracker would have made of the clip, and what the model sees of that.
EncodedClip damaged(const Scene& scene, std::size_t i, const TestRunOptions& options) {
  EncodedClip clip = encode_clip(scene.tests[i], scene.modalities, options.camera, false);
  damage_track(clip.track, clip.motion.skeleton, options.damage, options.regeneration.seed + i);
  clip.track_features = scene.modalities.encode_track(smooth_track(clip.track), clip.camera);
  return clip;
}

Motion motion_of(const Scene& scene, const EncodedClip& truth, const MatrixF& pose,
                 const std::optional<TrackFitSettings>& fit) {
  return fit_to_track(pose, scene.modalities, truth.track, {truth.camera, truth.motion.skeleton},
                      fit)
      .motion;
}

/// NaN in the same places.
bool same(const auto& a, const auto& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         (a.array() == b.array() || (a.array().isNaN() && b.array().isNaN())).all();
}

bool same_track(const Track2d& x, const Track2d& y) {
  return same(x.x_px, y.x_px) && same(x.y_px, y.y_px) && same(x.confidence, y.confidence);
}

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

void check_regeneration(const ScoredAnswer& got, const Motion& want, const EncodedClip& truth,
                        const Modalities& modalities) {
  CHECK(largest(got.motion.channels - want.channels) < 1e-9);
  const ClipScore score = score_clip(truth, want, modalities.root_name());
  CHECK(got.score.error.mpjpe_mm == doctest::Approx(score.error.mpjpe_mm));
  CHECK(got.score.pcc_channel == doctest::Approx(score.pcc_channel));
  CHECK(got.score.root_mm == doctest::Approx(score.root_mm));
}

}  // namespace

TEST_CASE("a test run shows the test clips' tracks as the damage left them, each by its own seed") {
  const Scene scene;
  on_every_device([&](Device& device) {
    TestRunOptions options = plain_options(scene);
    options.damage = {.noise_px = 3, .missing_share = 0.05, .hidden_s = 0.1};
    options.regeneration.seed = 70;
    const auto results = run_test(scene.model(device), scene.tests, options);
    REQUIRE(results.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
      CAPTURE(i);
      const EncodedClip want = damaged(scene, i, options);
      const EncodedClip& got = results[i].truth;
      CHECK(got.file == scene.tests[i]);
      CHECK(got.motion.channels == want.motion.channels);
      CHECK(got.camera.camera_from_world == want.camera.camera_from_world);
      CHECK(got.camera.width_px == 1280);
      CHECK(same_track(got.track, want.track));
      CHECK(same(got.track_features, want.track_features));
      CHECK(got.pose_features == want.pose_features);
    }
    options.damage = {};
    const auto whole = run_test(scene.model(device), scene.tests, options);
    CHECK_FALSE(same_track(whole[0].truth.track, results[0].truth.track));
    CHECK(whole[1].truth.track.confidence.minCoeff() == 1.0);
  });
}

TEST_CASE("a test run names the clip that cannot be answered") {
  const Scene scene;
  TestRunOptions options = plain_options(scene);
  options.damage.missing_share = 1;
  on_every_device([&](Device& device) {
    CHECK_THROWS_WITH_AS(
        run_test(scene.model(device), {scene.tests[1]}, options),
        doctest::Contains((scene.tests[1].string() + ": the 2D track never shows").c_str()),
        InputError);
  });
}

TEST_CASE("a test run scores 2D from the true motion, whatever befell the tracks") {
  const Scene scene;
  on_every_device([&](Device& device) {
    TestRunOptions options = plain_options(scene);
    options.damage = {.noise_px = 3, .missing_share = 0.05, .hidden_s = 0.1};
    const Model model = scene.model(device);
    const auto results = run_test(model, scene.tests, options);
    const auto clips = report_clips(model, results, false);
    REQUIRE(clips.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
      CAPTURE(i);
      const Motion clip = load_clip(scene.tests[i], {.fps = kFps});
      const Camera camera = place_camera(clip, scene.test_view);
      const Track2d truth = project_motion(clip, camera),
                    answer = regenerate_track(model, clip, {}, camera).at(0);
      CHECK(clips[i].track.track_error_px == track_error_px(truth, answer, "Hips"));
      const Track2d mean = scene.modalities.track_features.decode(
          scene.modalities.track_scale.mean().replicate(clip.frames(), 1), kFps, 1280, 720);
      CHECK(clips[i].track.mean_track_error_px == track_error_px(truth, mean, "Hips"));
      CHECK(results[i].track.track_error_px != results[i].track.mean_track_error_px);
    }
  });
}

TEST_CASE("a test run's samples are the network's, with the options that were given") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    for (const bool fit : {false, true}) {
      TestRunOptions options = plain_options(scene);
      if (fit) {
        options.fit = TrackFitSettings{};
        options.fit->orientation_deviation_deg = 10;
      }
      options.damage.noise_px = 2;
      options.regeneration.seed = 70;
      options.regeneration.samples = 2;
      options.regeneration.temperature = 0.9;
      options.regeneration.sampling = {
          .gibbs_steps = 2, .mrbm_gibbs_steps = 3, .steady = true, .scale = 0.8};
      const auto results = run_test(model, scene.tests, options);
      std::vector<MatrixF> tracks;
      for (std::size_t i = 0; i < 3; ++i)
        tracks.push_back(damaged(scene, i, options).track_features);
      const auto poses = regenerate(model.network, tracks, options.regeneration);
      RegenerationOptions single;
      single.run_in = 4;
      const auto answers = regenerate(model.network, tracks, single);
      for (std::size_t i = 0; i < 3; ++i) {
        CAPTURE(i);
        const EncodedClip truth = damaged(scene, i, options);
        REQUIRE(results[i].samples.size() == 2);
        for (std::size_t s = 0; s < 2; ++s)
          check_regeneration(results[i].samples[s],
                             motion_of(scene, truth, poses[2 * i + s], options.fit), truth,
                             scene.modalities);
        REQUIRE(results[i].other_answers.size() == 1);
        check_regeneration(results[i].other_answers.at(kMeanField),
                           motion_of(scene, truth, answers[i], options.fit), truth,
                           scene.modalities);
      }
    }
    // At temperature 0 the sample is the answer itself.
    const auto results = run_test(model, scene.tests, plain_options(scene));
    for (const ClipResult& result : results) {
      CHECK(result.samples.size() == 1);
      CHECK(result.other_answers.empty());
    }
  });
}

TEST_CASE("a test run in several goes draws other numbers for other clips") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    TestRunOptions options = plain_options(scene);
    options.regeneration.seed = 20;
    options.regeneration.samples = 33;  // 64 sequences at once: a clip at a time
    options.regeneration.temperature = 1.0;
    const auto results = run_test(model, scene.tests, options);
    for (std::size_t i = 0; i < 3; ++i) {
      const EncodedClip truth = damaged(scene, i, options);
      RegenerationOptions own = options.regeneration;
      own.seed = 20 + i;
      const auto poses = regenerate(model.network, {truth.track_features}, own);
      REQUIRE(results[i].samples.size() == 33);
      for (const std::size_t s : {0U, 32U})
        check_regeneration(results[i].samples[s], motion_of(scene, truth, poses[s], std::nullopt),
                           truth, scene.modalities);
    }
  });
}

TEST_CASE("a test run's baselines learn from the training clips and answer as the model does") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    TestRunOptions options = plain_options(scene);
    options.baselines = usual_baselines();
    options.damage = {.noise_px = 2, .missing_share = 0.02, .hidden_s = 0};
    std::vector<MatrixF> tracks, poses;
    for (const auto& file : scene.training) {
      // Through the model's own view, whole.
      const EncodedClip clip = encode_clip(file, scene.modalities, scene.model_view, false);
      tracks.push_back(clip.track_features);
      poses.push_back(clip.pose_features);
    }
    // The perceptron alone learns from the views, where there are any.
    options.view_tracks = {random_matrix(11, static_cast<std::size_t>(tracks[0].cols()), 5)};
    options.view_poses = {random_matrix(11, static_cast<std::size_t>(poses[0].cols()), 6)};
    const auto results = run_test(model, scene.tests, options);
    std::vector<std::unique_ptr<Baseline>> baselines;
    for (const char* name : {"mean_pose", "hold_last_frame", "nearest_neighbour", "ridge_window"}) {
      baselines.push_back(make_baseline(name, device, true));
      baselines.back()->fit(tracks, poses);
    }
    baselines.push_back(std::make_unique<MlpWindow>(device, MlpWindow::Settings::for_views()));
    baselines.back()->fit(options.view_tracks, options.view_poses);
    for (std::size_t i = 0; i < 3; ++i) {
      const EncodedClip truth = damaged(scene, i, options);
      CHECK(results[i].other_answers.size() == 5);
      for (const auto& baseline : baselines) {
        CAPTURE(baseline->name());
        REQUIRE(results[i].other_answers.count(baseline->name()) == 1);
        const auto predict = [&](const MatrixF& track) { return baseline->predict(track); };
        const MatrixF seen =
            fill_gaps(scene.modalities, truth.track_features, truth.track,
                      {{truth.camera, truth.motion.skeleton}, std::nullopt}, predict);
        check_regeneration(results[i].other_answers.at(baseline->name()),
                           motion_of(scene, truth, predict(seen), std::nullopt), truth,
                           scene.modalities);
      }
    }
  });
}

TEST_CASE("a test run scores the baselines that are asked for, which learn from the clips") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    TestRunOptions options = plain_options(scene);
    options.baselines = {"mean_pose", "twin_gaussian_process"};
    std::vector<MatrixF> tracks, poses;
    for (const auto& file : scene.training) {
      const EncodedClip clip = encode_clip(file, scene.modalities, scene.model_view, false);
      tracks.push_back(clip.track_features);
      poses.push_back(clip.pose_features);
    }
    // These are the perceptron's.
    options.view_tracks = {random_matrix(11, static_cast<std::size_t>(tracks[0].cols()), 5)};
    options.view_poses = {random_matrix(11, static_cast<std::size_t>(poses[0].cols()), 6)};
    std::vector<std::string> shown;
    options.progress = [&](const std::string& what, double) { shown.push_back(what); };
    const ClipResult result = run_test(model, {scene.tests[1]}, options).at(0);
    CHECK(result.other_answers.size() == 2);
    const auto baseline = make_baseline("twin_gaussian_process", device, true);
    baseline->fit(tracks, poses);
    check_regeneration(result.other_answers.at("twin_gaussian_process"),
                       motion_of(scene, result.truth,
                                 baseline->predict(result.truth.track_features), std::nullopt),
                       result.truth, scene.modalities);
    REQUIRE(shown.size() == 4);
    CHECK(shown[2] == "baseline mean_pose");
    CHECK(shown[3] == "baseline twin_gaussian_process");
  });
}

TEST_CASE("without views the perceptron learns from the training clips, at its full length") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    TestRunOptions options = plain_options(scene);
    options.camera = scene.model_view;
    options.include_training = true;
    options.baselines = usual_baselines();
    const auto before = device.launch_count();
    const auto results = run_test(model, {scene.training[0]}, options);
    // 40 epochs of at least 40 mini-batches, each of more than ten launches; with views it would be
    // six such epochs.
    CHECK(device.launch_count() - before > 40 * 40 * 10);
    // It was trained on these 23 frames, and answers nothing else: far nearer than the mean pose.
    const auto& others = results[0].other_answers;
    CHECK(others.at("mlp_window").score.error.mpjpe_mm <
          0.3 * others.at("mean_pose").score.error.mpjpe_mm);
  });
}

TEST_CASE("a clip that was trained on is refused, by its bytes, unless it is wanted and marked") {
  const Scene scene;
  on_every_device([&](Device& device) {
    const Model model = scene.model(device);
    TestRunOptions options = plain_options(scene);
    const auto copy = scene.folder / "renamed.bvh";
    std::filesystem::copy_file(scene.training[1], copy,
                               std::filesystem::copy_options::overwrite_existing);
    for (const auto& file : {scene.training[0], copy}) {
      try {
        run_test(model, {scene.tests[0], file}, options);
        FAIL("not refused");
      } catch (const InputError& error) {
        CHECK(std::string(error.what()).find(file.string()) == 0);
      }
    }
    options.include_training = true;
    const auto results = run_test(model, {scene.tests[0], copy, scene.training[0]}, options);
    REQUIRE(results.size() == 3);
    CHECK_FALSE(results[0].trained_on);
    CHECK(results[1].trained_on);
    CHECK(results[2].trained_on);
  });
}

TEST_CASE("a leading calibration pose is kept in test and training clips alike, if it is to be") {
  const Scene scene;
  on_every_device([&](Device& device) {
    Model model = scene.model(device);
    Motion posed = paced_clip(40, 1.0);
    posed.channels.row(0).setZero();  // a T-pose, far from the next frame
    const auto file = scene.write("posed.bvh", posed);
    posed.channels.row(5) *= 1.01;  // other bytes
    const auto test = scene.write("test.bvh", posed);
    TestRunOptions options = plain_options(scene);
    CHECK(run_test(model, {test}, options)[0].truth.motion.frames() == 39);
    options.keep_first_frame = true;
    CHECK(run_test(model, {test}, options)[0].truth.motion.frames() == 40);
    // The mean pose is that of all training frames that were kept.
    model.training_clips = {identify_clip(file)};
    options.baselines = usual_baselines();
    options.view_tracks = {random_matrix(
        3, static_cast<std::size_t>(scene.modalities.track_scale.output_dimension()), 5)};
    options.view_poses = {random_matrix(
        3, static_cast<std::size_t>(scene.modalities.pose_scale.output_dimension()), 6)};
    const auto result = run_test(model, {test}, options).at(0);
    const EncodedClip kept = encode_clip(file, scene.modalities, scene.model_view, true);
    REQUIRE(kept.pose_features.rows() == 40);
    const MatrixF mean = kept.pose_features.colwise().mean().replicate(40, 1);
    CHECK(largest(joint_positions(result.other_answers.at("mean_pose").motion) -
                  joint_positions(motion_of(scene, result.truth, mean, std::nullopt))) < 1e-2);
  });
}

TEST_CASE(
    "training clips that are gone matter to the baselines alone; a run reports its progress") {
  const Scene scene;
  on_every_device([&](Device& device) {
    Model model = scene.model(device);
    model.training_clips[1].path = (scene.folder / "gone.bvh").string();
    TestRunOptions options = plain_options(scene);
    std::vector<std::pair<std::string, double>> shown;
    options.progress = [&](const std::string& what, double fraction) {
      shown.emplace_back(what, fraction);
    };
    CHECK(run_test(model, {scene.tests[1]}, options).size() == 1);
    REQUIRE(shown.size() == 2);
    CHECK(shown[0].first == "reading clips");
    CHECK(shown[0].second == 0.0);
    CHECK(shown[1].first == "regenerating");
    CHECK(shown[1].second == doctest::Approx(0.1));
    options.baselines = usual_baselines();
    try {
      run_test(model, {scene.tests[1]}, options);
      FAIL("not refused");
    } catch (const InputError& error) {
      CHECK(std::string(error.what()).find("gone.bvh") != std::string::npos);
    }
  });
}

}  // namespace comparison_run_wiring_test
