#include <array>

#include "fitting/blas_kernels.hpp"
#include "run_program.hpp"

namespace mcdbn::cli {
namespace {

constexpr std::array<AddCommand, 15> kCommands = {
    add_devices_command,   add_synthesize_command, add_project_command,    add_render_command,
    add_corpus_command,    add_train_command,      add_regenerate_command, add_generate_command,
    add_evaluate_command,  add_fit_command,        add_sample_command,     add_score_command,
    add_transform_command, add_info_command,       add_bench_command,
};

}  // namespace
}  // namespace mcdbn::cli

int main(int argc, char** argv) {
  mcdbn::choose_blas_kernels();
  return mcdbn::cli::run_program(argc, argv, mcdbn::cli::kCommands);
}
