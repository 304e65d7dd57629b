#pragma once

namespace mcdbn::cli {

/// Starts a thread that waits for SIGINT and SIGTERM, which are blocked until then, and asks the
/// library to stop (request_interruption). A second signal ends the program at once, with this exit
/// code.
void start_signal_thread(int exit_code);

}  // namespace mcdbn::cli
