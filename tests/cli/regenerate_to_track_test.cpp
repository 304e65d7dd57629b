// The other direction: what regenerate makes of 3D motion, compared with what the library makes of
// it.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstring>
#include <optional>

#include "base/text_file.hpp"
#include "library_calls.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "mcdbn/motion_model/clip_regeneration.hpp"
#include "tiny_pipeline.hpp"

namespace regenerate_to_track_test {

using namespace mcdbn::test;
namespace fs = std::filesystem;

TEST_CASE("regenerate --to track: 2D from a clip, as the library makes it") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path file = pipeline.motion() / "walk_s02_01.bvh";
  REQUIRE(run_cli(fmt::format("project '{}' -o '{}' --write-camera '{}' --camera-azimuth -50 "
                              "--image-size 640 480",
                              file.string(), (folder / "seen.csv").string(),
                              (folder / "camera.yaml").string()))
              .exit_code == 0);
  const mcdbn::Model model = load_model(usual_device(), pipeline.model());
  const mcdbn::Motion clip = mcdbn::load_clip(file, {.fps = model.modalities.fps});
  const auto wanted = [&](const mcdbn::RegenerationOptions& options,
                          const std::optional<mcdbn::Camera>& camera = {}) {
    std::vector<std::string> texts;
    for (const mcdbn::Track2d& track : regenerate_track(model, clip, options, camera)) {
      write_track_csv(folder / "wanted.csv", track);
      texts.push_back(mcdbn::read_text_file(folder / "wanted.csv"));
    }
    return texts;
  };
  const auto call_of = [&](const fs::path& clip_file) {
    return fmt::format("regenerate --model '{}' --to track --input '{}' -o '{}'",
                       pipeline.model().string(), clip_file.string(),
                       (folder / "out.csv").string());
  };
  const std::string plain = call_of(file);
  const auto written = [&](const std::string& options, const std::vector<const char*>& files) {
    const CliResult result = run_cli(plain + options);
    CAPTURE(result.standard_error);
    REQUIRE(result.exit_code == 0);
    CHECK(result.standard_output.empty());
    std::vector<std::string> texts;
    for (const char* file : files) texts.push_back(mcdbn::read_text_file(folder / file));
    return texts;
  };
  mcdbn::RegenerationOptions options;
  options.sampling = model.network.sampling;
  const auto answer = written("", {"out.csv"});
  CHECK(answer == wanted(options));
  CHECK(mcdbn::read_track_csv(folder / "out.csv").frames() == clip.frames());
  const auto seen =
      written(fmt::format(" --camera '{}'", (folder / "camera.yaml").string()), {"out.csv"});
  CHECK(seen == wanted(options, mcdbn::read_camera(folder / "camera.yaml")));
  CHECK(seen != answer);
  const std::string of_posed = call_of(with_calibration_pose(file, folder / "posed.bvh"));
  REQUIRE(run_cli(of_posed).exit_code == 0);
  CHECK(mcdbn::read_text_file(folder / "out.csv") == answer.front());
  REQUIRE(run_cli(of_posed + " --keep-first-frame").exit_code == 0);
  CHECK(mcdbn::read_track_csv(folder / "out.csv").frames() == clip.frames() + 1);
  options.samples = 2;
  options.temperature = 0.7;
  options.seed = 9;
  options.sampling = {2, 3, false, 1.0};
  CHECK(written(" --samples 2 --temperature 0.7 --seed 9 --gibbs-steps 2 --mrbm-gibbs-steps 3",
                {"out_01.csv", "out_02.csv"}) == wanted(options));

  for (const char* other :
       {"--fit none", "--fit track", "--skeleton clip.bvh", "--camera-pitch 3", "--camera-roll 3",
        "--camera-fov 50", "--format csv", "--person 1", "--fps 25", "--image-size 640 480"}) {
    CAPTURE(other);
    const CliResult refused = run_cli(plain + " " + other);
    CHECK(refused.exit_code == 2);
    const std::string flag(other, std::strcspn(other, " "));
    CHECK(refused.standard_error.find(flag + " is for --to pose") != std::string::npos);
  }
  const CliResult no_clip =
      run_cli(fmt::format("regenerate --model '{}' --to track --input '{}' -o o.csv",
                          pipeline.model().string(), (folder / "seen.csv").string()));
  CHECK(no_clip.exit_code == 3);
  CHECK(no_clip.standard_error.find("seen.csv") != std::string::npos);
}

}  // namespace regenerate_to_track_test
