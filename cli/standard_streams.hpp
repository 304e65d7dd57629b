#pragma once

namespace mcdbn::cli {

/// The program may be started with its standard input, output or error closed. The first files
/// that it opens would be taken for them then, and messages written into them: what is closed is
/// opened so that using it fails.
void occupy_standard_streams();

}  // namespace mcdbn::cli
