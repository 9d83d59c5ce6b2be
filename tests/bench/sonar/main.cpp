// Simulated sonars compared with real ones: the same statistics of both, at the same places.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "plot.hpp"
#include "saphira/base/text.hpp"
#include "saphira/command_line/command_line.hpp"
#include "simulated.hpp"
#include "support/guarded.hpp"

using namespace saphira::bench;
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uint64_t kSeed = 1;

json to_json(const std::vector<RangeBin>& bins) {
  json out = json::array();
  for (const RangeBin& bin : bins)
    out.push_back({{"range_m", bin.range},
                   {"bias_m", bin.bias},
                   {"deviation_m", bin.deviation},
                   {"outliers", bin.outliers},
                   {"count", bin.count}});
  return out;
}

json to_json(const CorridorStatistics& s) {
  json lobe = json::array();
  for (const auto& [bin, heard] : s.lobe)
    lobe.push_back(
        {{"off_axis_deg", 4 * bin}, {"heard", heard.share()}, {"count", heard.yes + heard.no}});
  return {{"side_rms_m", s.side_rms},
          {"side_none", s.side_none},
          {"oblique_none", s.oblique_none},
          {"oblique_post", s.oblique_post},
          {"oblique_wall", s.oblique_wall},
          {"oblique_other", s.oblique_other},
          {"half_width_deg", saphira::degrees(s.half_width)},
          {"lobe", lobe}};
}

json to_json(const RingStatistics& s) {
  json beside = json::array();
  for (std::size_t i = 0; i < s.beside.size(); ++i)
    beside.push_back({{"off_deg", 15 * i},
                      {"wall", s.beside[i].wall},
                      {"axis", s.beside[i].axis},
                      {"none", s.beside[i].none},
                      {"other", s.beside[i].other}});
  return {{"rings", s.rings}, {"beside", beside}, {"deviation_m", s.deviation}};
}

// Prints a row: its label, and a figure for each of the compared data sets.
void row(const char* what, std::initializer_list<double> values, const char* form = "%12.3f") {
  std::printf("%-46s", what);
  for (const double value : values)
    std::printf(form, value);
  std::printf("\n");
}

std::vector<saphira::Vec2> deviations(const std::vector<RangeBin>& bins) {
  std::vector<saphira::Vec2> out;
  for (const RangeBin& bin : bins)
    if (bin.outliers < 0.5)
      out.emplace_back(bin.range, bin.deviation * 1000.0);
  return out;
}

std::vector<saphira::Vec2> lobe(const CorridorStatistics& s) {
  std::vector<saphira::Vec2> out;
  for (int bin = 0; bin <= 7; ++bin) {
    Heard both;
    for (const int side : {bin, -bin})
      if (const auto found = s.lobe.find(side); found != s.lobe.end()) {
        both.yes += found->second.yes;
        both.no += found->second.no;
      }
    if (both.yes + both.no > 0)
      out.emplace_back(4.0 * bin, both.share());
  }
  return out;
}

std::vector<saphira::Vec2> aside(const RingStatistics& s) {
  std::vector<saphira::Vec2> out;
  for (std::size_t i = 0; i < s.beside.size(); ++i)
    out.emplace_back(15.0 * static_cast<double>(i), s.beside[i].wall);
  return out;
}

int run(const fs::path& data, const std::string& plot, bool as_json) {
  const auto read = [&](const char* path) { return saphira::read_file((data / path).string()); };
  const saphira::sim::SonarModel model;
  const saphira::sim::SonarModel rays = plain_rays();

  const std::string csv = read("sonar-calibration/calibration.csv");
  const auto first = parse_calibration(csv, "sonar1", "calibration.csv");
  const auto second = parse_calibration(csv, "sonar2", "calibration.csv");
  const auto first_bins = range_bins(first);
  const auto second_bins = range_bins(second);
  const auto simulated_bins = range_bins(simulate(second, model, kSeed));

  const auto straight = straight_part(parse_corridor(read("sonar-corridor/measurement.txt"),
                                                     read("sonar-corridor/poses.txt"),
                                                     (data / "sonar-corridor").string()));
  const Corridor corridor = fit_corridor(straight);
  const auto real_corridor = corridor_statistics(straight, corridor);
  const auto simulated_corridor =
      corridor_statistics(simulate(straight, corridor, model, kSeed), corridor);
  const auto ray_corridor =
      corridor_statistics(simulate(straight, corridor, rays, kSeed), corridor);

  const auto rings =
      parse_ring(read("sonar-scitos/sensor_readings_24.data"), "sensor_readings_24.data");
  const auto real_ring = ring_statistics(rings);
  const auto simulated_ring = ring_statistics(simulate(rings, model, kSeed));
  const auto ray_ring = ring_statistics(simulate(rings, rays, kSeed));

  std::printf("A plate head-on (%zu readings)%16s%12s%12s%12s\n", first.size(), "", "sensor 1",
              "sensor 2", "simulated");
  for (std::size_t i = 0; i < simulated_bins.size(); ++i) {
    const auto& [a, b, c] = std::tie(first_bins[i], second_bins[i], simulated_bins[i]);
    std::printf("  %.2f m: deviation mm / outliers %%%*s", c.range, 12, "");
    for (const RangeBin* bin : {&a, &b, &c})
      std::printf("%6.1f /%4.0f", bin->deviation * 1000.0, bin->outliers * 100.0);
    std::printf("\n");
  }
  std::printf("\nA corridor, %zu records, walls %.2f m apart, %zu posts%6s%12s%12s%12s\n",
              straight.size(), corridor.left.offset - corridor.right.offset, corridor.posts.size(),
              "", "real", "simulated", "plain rays");
  const auto corridor_row = [&](const char* what, double CorridorStatistics::*value,
                                double factor = 1.0) {
    row(what, {factor * real_corridor.*value, factor * simulated_corridor.*value,
               factor * ray_corridor.*value});
  };
  corridor_row("  side sonars: no echo", &CorridorStatistics::side_none);
  corridor_row("  side sonars: rms about the wall, m", &CorridorStatistics::side_rms);
  corridor_row("  oblique sonars: no echo", &CorridorStatistics::oblique_none);
  corridor_row("  oblique sonars: a post", &CorridorStatistics::oblique_post);
  corridor_row("  oblique sonars: the smooth wall", &CorridorStatistics::oblique_wall);
  corridor_row("  oblique sonars: other", &CorridorStatistics::oblique_other);
  corridor_row("  half of the posts heard at, degrees off axis", &CorridorStatistics::half_width,
               saphira::degrees(1.0));
  std::printf("\nBeside a wall, %zu rings of 24%20s%12s%12s%12s\n", real_ring.rings, "", "real",
              "simulated", "plain rays");
  for (std::size_t i = 1; i < real_ring.beside.size(); ++i) {
    const auto label = [&](const char* what) {
      return "  " + std::to_string(15 * i) + " degrees off its normal: " + what;
    };
    const auto& [a, b, c] =
        std::tie(real_ring.beside[i], simulated_ring.beside[i], ray_ring.beside[i]);
    row(label("heard").c_str(), {a.wall, b.wall, c.wall});
    row(label("at the axis").c_str(), {a.axis, b.axis, c.axis});
    row(label("no echo").c_str(), {a.none, b.none, c.none});
  }
  row("  deviation between readings, mm (real)", {real_ring.deviation * 1000.0});

  if (!plot.empty()) {
    const std::string real = "#c8580f";
    const std::string other = "#e0a030";
    const std::string simulated = "#1f77b4";
    const std::string grey = "#9aa0a8";
    std::ofstream out(plot);
    out << plot_svg({{"Noise of a range, head-on",
                      "range, m",
                      "deviation, mm",
                      4.0,
                      24.0,
                      {{"real sensor 1", real, deviations(first_bins)},
                       {"real sensor 2", other, deviations(second_bins)},
                       {"simulated", simulated, deviations(simulated_bins)}}},
                     {"Door posts heard",
                      "degrees off the axis",
                      "share",
                      32.0,
                      1.0,
                      {{"real corridor", real, lobe(real_corridor)},
                       {"simulated", simulated, lobe(simulated_corridor)},
                       {"plain rays", grey, lobe(ray_corridor)}}},
                     {"A smooth wall heard, at its distance",
                      "degrees off its normal",
                      "share",
                      60.0,
                      1.0,
                      {{"real ring", real, aside(real_ring)},
                       {"simulated", simulated, aside(simulated_ring)},
                       {"plain rays", grey, aside(ray_ring)}}}})
        << std::flush;
    if (!out)
      throw std::runtime_error(plot + ": cannot be written");
  }
  if (as_json)
    std::printf("%s\n", json{{"plate",
                              {{"sensor_1", to_json(first_bins)},
                               {"sensor_2", to_json(second_bins)},
                               {"simulated", to_json(simulated_bins)}}},
                             {"corridor",
                              {{"real", to_json(real_corridor)},
                               {"simulated", to_json(simulated_corridor)},
                               {"plain_rays", to_json(ray_corridor)}}},
                             {"ring",
                              {{"real", to_json(real_ring)},
                               {"simulated", to_json(simulated_ring)},
                               {"plain_rays", to_json(ray_ring)}}}}
                            .dump()
                            .c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  saphira::CommandLine app{"Simulated sonars against data of real ones"};
  bool as_json = false;
  std::string plot;
  std::string data;
  app.add_flag("--json", as_json, "one JSON object on the last line");
  app.add_option("--plot", plot, "draw the comparison into a picture (SVG)");
  app.add_option("--data", data, "the folder of the data sets (see tests/bench/sonar/README.md)")
      .environment("SAPHIRA_DATA");
  if (const auto code = app.parse(argc, argv))
    return *code;
  if (data.empty() || !fs::is_directory(fs::path(data) / "sonar-corridor")) {
    std::cerr << "saphira-bench-sonar: no data" << (data.empty() ? "" : " in " + data)
              << ": give --data (or SAPHIRA_DATA) a folder that holds sonar-calibration, "
                 "sonar-corridor and sonar-scitos; tests/bench/sonar/README.md says where they "
                 "come from\n";
    return 2;
  }
  return saphira::test::guarded([&] { return run(data, plot, as_json); }, 2);
}
