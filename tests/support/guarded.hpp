#pragma once

#include <errno.h>

#include <cstdio>
#include <exception>

namespace saphira::test {

/// The exit code of a program's work; where that throws, `broken`, with the reason on stderr.
template <class Work>
int guarded(Work work, int broken = 1) {
  try {
    return work();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program_invocation_short_name, error.what());
    return broken;
  }
}

}  // namespace saphira::test
