// The CPU time of behaviors and intentions in one cycle, without the bus.

#include <cstdio>
#include <exception>

#include "executive_bench.hpp"
#include "saphira/command_line/command_line.hpp"

int main(int argc, char** argv) {
  using namespace saphira::bench;
  bool json = false;
  saphira::CommandLine app{"CPU time of behaviors and intentions in one cycle, without the bus"};
  app.add_flag("--json", json, "one JSON object");
  if (const auto code = app.parse(argc, argv))
    return *code;
  try {
    const double intentions_12 = intentions_12_ms();
    const double behaviors_10 = behaviors_10_ms();
    const double behaviors_1000 = behaviors_1000_ms();
    const double intentions_10000 = intentions_10000_ms();
    if (json) {
      std::printf(
          "{\"paper_load_ms\": %.5f, \"intentions_12_ms\": %.5f, \"behaviors_10_ms\": %.5f, "
          "\"behaviors_1000_ms\": %.4f, \"intentions_10000_ms\": %.4f}\n",
          intentions_12 + behaviors_10, intentions_12, behaviors_10, behaviors_1000,
          intentions_10000);
    } else {
      std::printf("CPU time of a cycle, without the bus\n");
      std::printf("  12 intentions and 10 behaviors (the paper's load)  %8.3f ms\n",
                  intentions_12 + behaviors_10);
      std::printf("  1,000 behaviors with 5,000 rules                   %8.3f ms\n",
                  behaviors_1000);
      std::printf("  10,000 intentions that wait                        %8.3f ms\n",
                  intentions_10000);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "saphira bench executive: %s\n", error.what());
    return 1;
  }
  return 0;
}
