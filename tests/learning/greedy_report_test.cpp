// What an observer of the greedy stages is given.

#include <doctest/doctest.h>

#include <cmath>

#include "learning/greedy_scene.hpp"

namespace greedy_report_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct Watched {
  Mcdbn model;
  std::vector<EpochReport> reports;
};

Watched watch(Device& device, const GreedyScene& scene) {
  std::vector<EpochReport> reports;
  Mcdbn model =
      train_on_device(device, scene, [&](const EpochReport& report) { reports.push_back(report); });
  return {std::move(model), reports};
}

/// Multiply-adds of a mini-batch row in every epoch of a CRBM, about: the history's products both
/// in the chain and in the update, the chain's two products a Gibbs step and three more.
double crbm_cost(double visible, const reference::GreedyPlan& plan, const reference::CdPlan& cd) {
  const double hidden = plan.hidden;
  return cd.epochs * (2.0 * plan.order * visible * (visible + hidden) +
                      (2.0 * cd.gibbs_steps + 3.0) * visible * hidden);
}

/// Of each stage in turn.
std::vector<double> costs_of(const GreedyScene& scene) {
  std::vector<double> costs;
  for (const auto* clips : {&scene.poses, &scene.tracks})
    for (int layer = 0; layer < scene.plan.layers; ++layer)
      costs.push_back(layer == 0 ? crbm_cost(static_cast<double>(clips->front().cols()), scene.plan,
                                             scene.plan.gaussian)
                                 : crbm_cost(scene.plan.hidden, scene.plan, scene.plan.binary));
  costs.push_back(6.0 * scene.plan.mrbm.epochs * scene.plan.mrbm.mean_field_steps * 2.0 *
                  scene.plan.hidden * scene.plan.mrbm_hidden);
  return costs;
}

void check_reports(const GreedyScene& scene) {
  const auto stages = train_on_host(scene).stages;
  const std::vector<double> costs = costs_of(scene);
  REQUIRE(costs.size() == stages.size());
  double total = 0;
  for (const double cost : costs) total += cost;
  on_every_device([&](Device& device) {
    const auto reports = watch(device, scene).reports;
    auto report = reports.begin();
    double done = 0;
    for (std::size_t s = 0; s < stages.size(); ++s) {
      const std::size_t epochs = stages[s].losses.size();
      for (std::size_t epoch = 1; epoch <= epochs; ++epoch, ++report) {
        INFO(stages[s].name, ", epoch ", epoch);
        REQUIRE(report != reports.end());
        CHECK(report->stage == stages[s].name);
        CHECK(report->epoch == epoch);
        CHECK(report->epochs == epochs);
        const double loss = stages[s].losses[epoch - 1];
        CHECK(std::abs(report->loss - loss) <= kGreedyTolerance * std::max(1.0, loss));
        const double part = static_cast<double>(epoch) / static_cast<double>(epochs);
        CHECK(report->stage_progress == doctest::Approx(part).epsilon(1e-12));
        CHECK(report->overall_progress ==
              doctest::Approx((done + costs[s] * part) / total).epsilon(1e-12));
        CHECK(report->windows_per_s > 0);
        CHECK(std::isfinite(report->windows_per_s));
        CHECK(!report->held_out_loss);
        CHECK(report->health.has_value() ==
              (epoch == 1 || epoch == epochs || epoch == 5 || epoch == 10));
      }
      done += costs[s];
    }
    CHECK(report == reports.end());
    CHECK(reports.back().overall_progress == doctest::Approx(1).epsilon(1e-12));
  });
}

GreedyScene scene_of_many_epochs() {
  GreedyScene scene = scene_of_different_sizes();
  scene.plan.gaussian.epochs = 11;
  scene.plan.binary.epochs = 7;
  scene.plan.mrbm.epochs = 6;
  return scene;
}

void check_health(const LayerHealth& got, const LayerHealth& want) {
  CHECK(got.hidden_activity == doctest::Approx(want.hidden_activity).epsilon(1e-4));
  CHECK(got.saturation == doctest::Approx(want.saturation).epsilon(1e-4));
  CHECK(got.weight_norm == doctest::Approx(want.weight_norm).epsilon(1e-5));
  const auto check_optional = [](const std::optional<double>& x, const std::optional<double>& y) {
    REQUIRE(x.has_value() == y.has_value());
    if (x) CHECK(*x == doctest::Approx(*y).epsilon(1e-4));
  };
  check_optional(got.weight_norm_A, want.weight_norm_A);
  check_optional(got.weight_norm_B, want.weight_norm_B);
  check_optional(got.free_run_error, want.free_run_error);
}

Sequences sequences_of(Device& device, const reference::GreedyCode& code) {
  std::vector<MatrixF> clips;
  for (const MatrixD& clip : code.clips) clips.push_back(clip.cast<float>());
  Sequences sequences = Sequences::from_host(device, clips);
  sequences.valid_from = static_cast<std::size_t>(code.valid_from);
  return sequences;
}

const LayerHealth& last_health(const std::vector<EpochReport>& reports, const std::string& stage) {
  const EpochReport* last = nullptr;
  for (const EpochReport& report : reports)
    if (report.stage == stage) last = &report;
  REQUIRE(last != nullptr);
  REQUIRE(last->health.has_value());
  return *last->health;
}

/// Rows of the codes that belong together, all clips one after another. @return {track, pose}
std::pair<MatrixF, MatrixF> pairs_of(const reference::GreedyCode& track,
                                     const reference::GreedyCode& pose, int look_ahead) {
  std::vector<RowVectorF> track_rows, pose_rows;
  for (std::size_t clip = 0; clip < pose.clips.size(); ++clip)
    for (Eigen::Index t = pose.valid_from; t + look_ahead < pose.clips[clip].rows(); ++t) {
      track_rows.emplace_back(track.clips[clip].row(t + look_ahead).cast<float>());
      pose_rows.emplace_back(pose.clips[clip].row(t).cast<float>());
    }
  const auto stacked = [](const std::vector<RowVectorF>& rows) {
    MatrixF matrix(rows.size(), rows.front().cols());
    for (std::size_t r = 0; r < rows.size(); ++r)
      matrix.row(static_cast<Eigen::Index>(r)) = rows[r];
    return matrix;
  };
  return {stacked(track_rows), stacked(pose_rows)};
}

}  // namespace

TEST_CASE("greedy reports: every epoch of every stage, its loss and how far the run is") {
  check_reports(scene_of_many_epochs());
  check_reports(scene_of_equal_sizes());
  check_reports(scene_without_history());
}

TEST_CASE("greedy reports: health is that of the stage's own layer on its own input") {
  const GreedyScene scene = scene_of_many_epochs();
  const reference::GreedyRun run = train_on_host(scene);
  on_every_device([&](Device& device) {
    const Watched watched = watch(device, scene);
    const std::size_t frames = static_cast<std::size_t>(scene.plan.order) + kFreeRunFrames;
    std::array<reference::GreedyCode, 2> codes{
        {{in_double(scene.tracks), 0}, {in_double(scene.poses), 0}}};
    for (const std::size_t modality : {modality::track, modality::pose}) {
      reference::GreedyCode& code = codes[modality];
      const Cdbn& cdbn = watched.model.cdbns[modality];
      for (std::size_t layer = 0; layer < cdbn.layers.size(); ++layer) {
        const std::string stage =
            (modality == modality::track ? "track." : "pose.") + std::to_string(layer);
        INFO(stage);
        const CrbmParameters parameters = cdbn.layers[layer].to_host();
        const LayerHealth want =
            crbm_health(parameters, health_windows(sequences_of(device, code), frames));
        CHECK(want.free_run_error.has_value());
        check_health(last_health(watched.reports, stage), want);
        code = reference::up_pass(in_double(parameters), code);
      }
    }
    const auto [track, pose] = pairs_of(codes[0], codes[1], scene.plan.look_ahead);
    check_health(last_health(watched.reports, "mrbm"),
                 mrbm_health(watched.model.mrbm.to_host(), {track, pose}));
  });
}

TEST_CASE("greedy reports: health at the first epoch is that after the first epoch") {
  GreedyScene scene = scene_of_many_epochs();
  scene.plan.gaussian.epochs = 2;
  GreedyScene shorter = scene;
  shorter.plan.gaussian.epochs = 1;
  on_every_device([&](Device& device) {
    const auto reports = watch(device, scene).reports;
    const auto wanted = watch(device, shorter).reports;
    REQUIRE(reports.front().health.has_value());
    check_health(*reports.front().health, last_health(wanted, "pose.0"));
    CHECK(reports.front().health->weight_norm !=
          doctest::Approx(last_health(reports, "pose.0").weight_norm).epsilon(1e-3));
  });
}

TEST_CASE("greedy reports: the MRBM's health is of a hundred pairs evenly over all of them") {
  constexpr std::size_t kFrames = 263, kLookAhead = 3, kPairs = kFrames - kLookAhead;
  LearningSettings settings = settings_of(tiny_plan());
  settings.look_ahead = kLookAhead;
  settings.mrbm.epochs = 1;
  const MatrixF track = (random_matrix(kFrames, 4, 1).array().abs()).matrix();
  const MatrixF pose = (random_matrix(kFrames, 5, 2).array().abs()).matrix();
  MatrixF some_track(100, 4), some_pose(100, 5);
  for (std::size_t i = 0; i < 100; ++i) {
    const auto at = static_cast<Eigen::Index>(i * kPairs / 100);
    some_track.row(static_cast<Eigen::Index>(i)) = track.row(at + kLookAhead);
    some_pose.row(static_cast<Eigen::Index>(i)) = pose.row(at);
  }
  const MrbmParameters initial = MrbmParameters::random(two_modalities(4, 5, 6), 2.0, {.seed = 3});
  on_every_device([&](Device& device) {
    std::vector<EpochReport> reports;
    const std::vector<Sequences> codes{Sequences::from_host(device, {track}),
                                       Sequences::from_host(device, {pose})};
    const Mrbm mrbm = train_mrbm(device, codes, initial, settings, 5,
                                 [&](const EpochReport& report) { reports.push_back(report); });
    REQUIRE(reports.size() == 1);
    CHECK(reports.front().stage == "mrbm");
    REQUIRE(reports.front().health.has_value());
    check_health(*reports.front().health, mrbm_health(mrbm.to_host(), {some_track, some_pose}));
    CHECK(reports.front().health->hidden_activity !=
          doctest::Approx(mrbm_health(mrbm.to_host(), {track.topRows(kPairs), pose.topRows(kPairs)})
                              .hidden_activity)
              .epsilon(1e-4));
  });
}

TEST_CASE("greedy reports: an observer that throws ends the training there") {
  struct Enough {};
  const GreedyScene scene = scene_of_different_sizes();
  on_every_device([&](Device& device) {
    std::vector<std::string> seen;
    const auto observer = [&](const EpochReport& report) {
      seen.push_back(report.stage + " " + std::to_string(report.epoch));
      if (report.stage == "pose.1" && report.epoch == 2) throw Enough{};
    };
    CHECK_THROWS_AS(train_on_device(device, scene, observer), Enough);
    CHECK(seen == std::vector<std::string>{"pose.0 1", "pose.0 2", "pose.0 3", "pose.0 4",
                                           "pose.1 1", "pose.1 2"});
  });
}

}  // namespace greedy_report_test
