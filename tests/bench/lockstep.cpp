// The speed of the whole system in lockstep: the demo, in one process and in separate ones.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/quantile.hpp"

namespace {

nlohmann::json demo(bool single, int seed) {
  std::vector<std::string> argv{"saphira", "demo",   "--headless",        "--lockstep",
                                "--json",  "--seed", std::to_string(seed)};
  if (single)
    argv.emplace_back("--single-process");
  std::string text = saphira::bench::output_of(argv);
  while (text.ends_with('\n'))
    text.pop_back();
  return nlohmann::json::parse(text.substr(text.rfind('\n') + 1));
}

}  // namespace

int main(int argc, char** argv) {
  saphira::CommandLine app{"Lockstep speed of the demo, as multiples of real time"};
  bool json = false;
  int runs = 5;
  app.add_flag("--json", json, "one JSON object on the last line");
  app.add_option("--runs", runs, "runs of each kind").in_range(1, 100);
  if (const auto code = app.parse(argc, argv))
    return *code;

  std::vector<double> single;
  std::vector<double> separate;
  for (int i = 1; i <= runs; ++i) {
    single.push_back(demo(true, i).at("speed_factor").get<double>());
    separate.push_back(demo(false, i).at("speed_factor").get<double>());
    std::printf("seed %d: one process %.0f x real time, separate processes %.0f x\n", i,
                single.back(), separate.back());
  }
  saphira::bench::print({{"single_process_x", saphira::test::quantile(single, 0.5)},
                         {"separate_x", saphira::test::quantile(separate, 0.5)}},
                        json);
  return 0;
}
