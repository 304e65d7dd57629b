#pragma once

namespace mcdbn::cli {

/// Whoever starts the program may have closed its standard input, output or error. The first files
/// that it opens would be taken for them then, and messages written into them: what is closed is
/// opened so that using it fails.
void occupy_standard_streams();

}  // namespace mcdbn::cli
