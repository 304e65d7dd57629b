// sample, score and transform: values and options that a machine cannot take are refused, those of
// an MRBM's modalities and those that are given to sample too.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <limits>

#include "fitted_machines.hpp"
#include "library_calls.hpp"
#include "mcdbn/base/matrix_file.hpp"
#include "tiny_pipeline.hpp"

namespace machine_values_test {

using namespace mcdbn::test;
using mcdbn::MatrixF;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinite = std::numeric_limits<float>::infinity();

TEST_CASE("a modality of an MRBM takes what its units can be") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const auto file = [&](const char* name) { return (folder / name).string(); };
  const auto random = mcdbn::MrbmParameters::random(
      {{{"bits", 2}, {"values", 3, mcdbn::VisibleKind::gaussian}}, 4}, 1.0, {7});
  mcdbn::save_machine(file("m.safetensors"), {mcdbn::Mrbm(usual_device(), random)});
  MatrixF values = MatrixF::Constant(3, 3, -7.0F);
  mcdbn::write_matrix(file("values.npy"), values);
  const std::string model = " --quiet --model " + file("m.safetensors"),
                    bits = " --modality bits=" + file("bits.npy"),
                    both = bits + " --modality values=" + file("values.npy");
  MatrixF given(3, 2);
  given << 0, 1, 0.25F, 1, 1, 0;
  for (const auto& [odd, words] :
       {std::pair{7.0F, "bits.npy: row 2, column 1 is 7; binary units need values from 0 to 1"},
        {-3.0F, "bits.npy: row 2, column 1 is -3; binary units need"},
        {kNan, "bits.npy: row 2, column 1 is nan; numbers are needed throughout"}}) {
    MatrixF changed = given;
    changed(1, 0) = odd;
    mcdbn::write_matrix(file("bits.npy"), changed);
    check_refused("transform" + model + bits + " --infer values", 3, words);
    check_refused("sample" + model + bits + " --infer values", 3, words);
    check_refused("score --model " + file("m.safetensors") + both, 3, words);
  }
  mcdbn::write_matrix(file("bits.npy"), given);
  CHECK(printed("transform" + model + bits + " --infer values").rows() == 3);
  // Gaussian units take any number.
  CHECK(printed("transform" + model + " --infer bits --modality values=" + file("values.npy"))
            .rows() == 3);
}

TEST_CASE("sample: what is given is from 0 to 1 where units are binary, and may be unknown") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const ScratchFolder folder;
  const std::string file = (folder / "given.npy").string();
  const auto call = [&](const char* kind) {
    return fmt::format("sample --quiet --model {} --given {}", machines.model(kind), file);
  };
  MatrixF given = MatrixF::Ones(2, 5);
  given(0, 3) = kNan;
  mcdbn::write_matrix(file, given);
  CHECK(printed(call("rbm")).rows() == 2);
  given(1, 2) = -3;
  mcdbn::write_matrix(file, given);
  check_refused(call("rbm"), 3, "given.npy: row 2, column 3 is -3; binary units need");
  CHECK(printed(call("gaussian-rbm")).rows() == 2);
  given(1, 2) = kInfinite;
  mcdbn::write_matrix(file, given);
  check_refused(call("gaussian-rbm"), 3,
                "given.npy: row 2, column 3 is inf; a number is needed, or nan");
}

TEST_CASE("score: what only --log-partition takes is refused without it") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const std::string call = "score --model " + machines.model("rbm") + " " + machines.bits();
  check_refused(call + " --temperatures 7", 2, "--temperatures is for --log-partition");
  check_refused(call + " --chains 2", 2, "--chains is for --log-partition");
  // The pseudo-log-likelihood is drawn with the seed, too.
  CHECK_FALSE(output_of(call + " --seed 3").empty());
}

TEST_CASE("fit: a machine of data that are large and not scaled can be used") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const auto file = [&](const char* name) { return (folder / name).string(); };
  MatrixF data(40, 2);
  for (Eigen::Index t = 0; t < data.rows(); ++t) data.row(t) << 1.7e9F, t % 2 ? -2e9F : 2e9F;
  mcdbn::write_matrix(file("large.npy"), data);
  output_of(
      fmt::format("fit {} --machine gaussian-rbm -o {} --hidden 3 --batch 20 --quiet "
                  "--gaussian-epochs 1 --gaussian-rate 1e-12",
                  file("large.npy"), file("m.safetensors")));
  const MatrixF code = printed(
      fmt::format("transform --quiet --model {} {}", file("m.safetensors"), file("large.npy")));
  CHECK(code.rows() == 40);
  CHECK(code.allFinite());
}

TEST_CASE("an MRBM's modality without a row is refused by every command, as a CSV without one is") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const auto file = [&](const char* name) { return (folder / name).string(); };
  const auto random = mcdbn::MrbmParameters::random({{{"a", 2}, {"b", 3}}, 4}, 1.0, {7});
  mcdbn::save_machine(file("m.safetensors"), {mcdbn::Mrbm(usual_device(), random)});
  const std::string model = " --model " + file("m.safetensors");
  for (const char* kind : {"npy", "csv"}) {
    CAPTURE(kind);
    const std::string a = file("a.") + kind, b = file("b.") + kind, words = a + ": no numbers";
    mcdbn::write_matrix(a, MatrixF(0, 2));
    mcdbn::write_matrix(b, MatrixF(0, 3));
    const std::string given = " --modality a=" + a;
    check_refused("score" + model + given + " --modality b=" + b, 3, words);
    check_refused("transform --quiet" + model + given + " --infer b", 3, words);
    check_refused("sample --quiet" + model + given + " --infer b", 3, words);
    check_refused("fit --machine mrbm --hidden 4 --batch 20 --mrbm-epochs 1 --quiet -o " +
                      file("new.safetensors") + given + " --modality b=" + b,
                  3, words);
  }
  CHECK(!std::filesystem::exists(file("new.safetensors")));
}

}  // namespace machine_values_test
