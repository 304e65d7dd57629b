#pragma once

namespace mcdbn::cli {

/// From here on SIGINT and SIGTERM, which wait until then, ask the library to stop
/// (request_interruption); a second one ends the program at once, with the exit code of an
/// interruption. A thread of its own waits for them.
void heed_signals(int exit_code);

}  // namespace mcdbn::cli
