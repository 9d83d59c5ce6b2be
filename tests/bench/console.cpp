// The cost of the console with three browsers and a large map, the delay from a packet to the
// pixels, and the frame rate of a page.
#include <stdlib.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bench.hpp"
#include "browser.hpp"
#include "page_files.hpp"
#include "saphira/base/places.hpp"
#include "saphira/command_line/command_line.hpp"
#include "support/guarded.hpp"
#include "support/process.hpp"
#include "support/quantile.hpp"

using namespace saphira;

namespace {

constexpr std::size_t kPages = 3;

/// The address with the key, from the console's output.
std::string address_in(const std::string& output) {
  const std::size_t begin = output.find("http://");
  if (begin == std::string::npos)
    throw std::runtime_error("the console printed no address:\n" + output);
  return output.substr(begin, output.find('\n', begin) - begin);
}

/// The size of the page [kB], compressed as gzip does.
double packed_kb() {
  double bytes = 0.0;
  for (const console::PageFile& file : console::page_files()) {
    uLongf size = compressBound(file.content.size());
    std::vector<Bytef> packed(size);
    if (compress2(packed.data(), &size, reinterpret_cast<const Bytef*>(file.content.data()),
                  file.content.size(), Z_BEST_COMPRESSION) != Z_OK)
      throw std::runtime_error("zlib fails");
    bytes += static_cast<double>(size);
  }
  return bytes / 1000.0;
}

/// The map of the office with further walls, up to that number of artifacts.
void write_map(const std::string& file, int artifacts) {
  std::ifstream office(config_folder() + "/maps/office.map");
  std::ofstream map(file);
  int count = 0;
  for (std::string line; std::getline(office, line); map << line << "\n")
    count += !line.empty() && line.front() != ';' ? 1 : 0;
  for (int i = count; i < artifacts; ++i)
    map << "WALL " << 500 * (i % 100) << ", " << 30000 + 500 * (i / 100) << ", " << 30 * (i % 12)
        << ", 400\n";
}

int run(unsigned seconds, int artifacts, bool json) {
  setenv("SAPHIRA_DOMAIN", "199", 1);
  setenv("SAPHIRA_ROBOT", "bench-console", 1);
  const test::TempDir folder;
  write_map(folder.path("large.map"), artifacts);
  test::Process up({"saphira", "up", "demo", "--set", "map=" + folder.path("large.map")},
                   folder.path("up"));
  if (!test::wait_until([&] { return up.output().find("#") != std::string::npos; }))
    throw std::runtime_error("no console:\n" + up.output());
  const std::string address = address_in(up.output());

  std::vector<std::unique_ptr<console::Browser>> browsers;
  const auto open_page = [&] {
    browsers.push_back(std::make_unique<console::Browser>());
    browsers.back()->open(1280, 800);
    browsers.back()->go(address);
    if (!browsers.back()->wait("!!document.querySelector('.link.live')"))
      throw std::runtime_error("the page shows no robot:\n" + up.output());
  };
  open_page();
  const double first_picture = browsers.front()
                                   ->value(
                                       "performance.getEntriesByName('first-contentful-paint')"
                                       "[0]?.startTime ?? 0")
                                   .get<double>();
  // The robot drives meanwhile: a static page costs less.
  const bench::Child goal({"saphira", "goal", "go", "16", "1"});
  sleep(3);  // maps and grids are there
  const double features =
      browsers.front()->value("saphira.data('map')?.artifacts.length ?? 0").get<double>();

  // One page: three browsers that draw by software on one machine would slow each other.
  browsers.front()->value(
      "saphira.delays.length = 0; window.frames = []; (function next(at) {"
      " frames.push(at); requestAnimationFrame(next); })(performance.now()); 0");
  sleep(seconds);
  auto delays = browsers.front()->value("saphira.delays").get<std::vector<double>>();
  auto intervals = browsers.front()
                       ->value("frames.slice(1).map((at, i) => at - frames[i])")
                       .get<std::vector<double>>();

  while (browsers.size() < kPages)
    open_page();
  sleep(3);
  pid_t gateway = -1;
  for (const pid_t pid : bench::family(up.pid()))
    if (bench::name_of(pid) == "saphira-console")
      gateway = pid;
  const double before = bench::cpu_seconds(gateway);
  sleep(seconds);
  const double cpu = 100.0 * (bench::cpu_seconds(gateway) - before) / seconds;
  if (delays.empty() || intervals.empty())
    throw std::runtime_error("nothing was drawn");
  bench::print({{"gateway_cpu_percent", cpu},
                {"gateway_mb", bench::resident_mb(gateway)},
                {"pages", kPages},
                {"packets", delays.size()},
                {"packet_to_page_ms_p50", test::quantile(delays, 0.5)},
                {"packet_to_page_ms_p99", test::quantile(delays, 0.99)},
                {"artifacts", features},
                {"frames_per_s", static_cast<double>(intervals.size()) / seconds},
                {"frame_ms_p99", test::quantile(intervals, 0.99)},
                {"page_kb_gzip", packed_kb()},
                {"first_picture_ms", first_picture}},
               json);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{"The console, live at 10 Hz: what one page draws, and what three cost"};
  bool json = false;
  unsigned seconds = 20;
  app.add_flag("--json", json, "one JSON object on the last line");
  int artifacts = 5000;
  app.add_option("--artifacts", artifacts, "of the map").in_range(0, 100000);
  app.add_option("--seconds", seconds, "how long to watch, twice").in_range(5, 3600);
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] { return run(seconds, artifacts, json); });
}
