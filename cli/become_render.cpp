#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "mcdbn/base/errors.hpp"
#include "program_folder.hpp"
#include "render.hpp"

namespace mcdbn::cli {

void run_render(const RenderCommandOptions&, const CommandContext& context) {
  const auto program = beside_program("libexec/mcdbn-cl/render");
  ::execv(program.c_str(), context.arguments);
  throw Error(fmt::format("the drawing program cannot be started, {}: {}", program.string(),
                          std::generic_category().message(errno)));
}

}  // namespace mcdbn::cli
