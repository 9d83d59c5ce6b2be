#pragma once

#include <string>

namespace saphira {

/// "could not write the output: No space left on device", for the errno of a failed write. Empty:
/// the reader has left (`| head`, a closed terminal), which is no failure.
std::string output_trouble(int fd, int why);

/// Flushes standard output, which may keep text until then. Returns the reason in words where that
/// or an earlier write failed; otherwise empty.
std::string flush_standard_output();

}  // namespace saphira
