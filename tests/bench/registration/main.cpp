// Where robots were, by their logs: dead reckoning and registration beside published figures.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "carmen.hpp"
#include "metrics.hpp"
#include "saphira/registration/scan_mapping.hpp"
#include "stamps.hpp"

using namespace saphira;
using namespace saphira::bench;
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

struct Figures {
  std::optional<RelationErrors> relations;
  std::optional<double> ate;
  std::optional<DriftErrors> drift;
};

struct DataSet {
  std::string name;
  CarmenLog raw;
  std::optional<CarmenLog> corrected;
  std::vector<Relation> relations;
  Clock clock = Clock::ipc;
  Trajectory odometry{{}};
  std::optional<Trajectory> reference;
  std::size_t mended = 0;
};

std::optional<fs::path> file_with(const fs::path& folder,
                                  std::initializer_list<const char*> parts) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    for (const char* part : parts)
      if (name.find(part) != std::string::npos) {
        found.push_back(entry.path());
        break;
      }
  }
  std::sort(found.begin(), found.end());
  return found.empty() ? std::nullopt : std::optional(found.front());
}

DataSet load(const fs::path& folder) {
  DataSet set;
  set.name = folder.filename().string();
  const auto raw = file_with(folder, {"raw.log", ".clf", "raw.gfs"});
  const auto corrected = file_with(folder, {"corrected"});
  const auto relations = file_with(folder, {".relations"});
  set.raw = parse_carmen(read_log(raw->string()), raw->string());
  for (std::size_t i = 0; i < set.raw.damaged.size() && i < 3; ++i)
    std::cerr << set.raw.damaged[i] << '\n';
  if (corrected)
    set.corrected = parse_carmen(read_log(corrected->string()), corrected->string());
  if (relations)
    set.relations = parse_relations(read_log(relations->string()), relations->string());
  // The clock that knows the relations' stamps, or that the corrected file has.
  const auto hits = [&](Clock clock) {
    const Trajectory track = time_base(set.raw, clock).odometry;
    std::size_t count = 0;
    for (const Relation& relation : set.relations)
      count += track.at(relation.from) && track.at(relation.to) ? 1U : 0U;
    return count;
  };
  if (!set.relations.empty()) {
    if (hits(Clock::logger) > hits(Clock::ipc))
      set.clock = Clock::logger;
  } else if (set.corrected) {
    const auto ipc = clock_offset(set.raw, Clock::ipc, *set.corrected);
    const auto logger = clock_offset(set.raw, Clock::logger, *set.corrected);
    if (ipc && logger && std::abs(*logger) < std::abs(*ipc))
      set.clock = Clock::logger;
  }
  const bool interpolated =
      set.raw.odometry.empty() && std::any_of(set.raw.scans.begin(), set.raw.scans.end(),
                                              [](const LaserScan& s) { return s.host == "A"; });
  TimeBase base = interpolated && set.corrected ? mend_stamps(set.raw, *set.corrected)
                                                : time_base(set.raw, set.clock);
  set.odometry = std::move(base.odometry);
  set.mended = base.mended;
  if (set.corrected) {
    const double offset = clock_offset(set.raw, set.clock, *set.corrected).value_or(0.0);
    std::vector<StampedPose> poses;
    for (const LaserScan& scan : set.corrected->scans)
      poses.push_back({scan.time.ipc + offset, scan.pose});
    set.reference.emplace(std::move(poses));
  }
  return set;
}

Figures evaluate(const DataSet& set, const Trajectory& estimate) {
  Figures out;
  if (!set.relations.empty())
    out.relations = relation_errors(estimate, set.relations);
  if (set.reference) {
    const Pairs pairs = pair_up(estimate, *set.reference);
    out.ate = ate_rmse(pairs);
    out.drift = drift(pairs, 10.0);
  }
  return out;
}

Trajectory scan_times(const DataSet& set, const std::vector<Pose>& poses) {
  std::vector<StampedPose> out;
  for (std::size_t i = 0; i < poses.size(); ++i)
    out.push_back({time_of(set.raw.scans[i].time, set.clock), poses[i]});
  return densify(Trajectory(std::move(out)), set.odometry);
}

void print(const char* what, const Figures& f) {
  std::printf("  %-34s", what);
  if (f.relations)
    std::printf(" %6.3f +- %6.3f m %5.2f +- %5.2f deg (most %.2f, %zu)",
                f.relations->translation.mean, f.relations->translation.deviation,
                degrees(f.relations->rotation.mean), degrees(f.relations->rotation.deviation),
                f.relations->translation.most, f.relations->translation.count);
  if (f.ate)
    std::printf("  ATE %6.3f m", *f.ate);
  if (f.drift)
    std::printf("  per 10 m %5.3f m %5.2f deg", f.drift->translation.median,
                degrees(f.drift->rotation.median));
  std::printf("\n");
  std::fflush(stdout);
}

int run(const std::string& data) {
  for (const char* name : {"intel", "fr101"}) {
    const fs::path folder = fs::path(data) / name;
    if (!fs::is_directory(folder))
      continue;
    DataSet set = load(folder);
    std::printf("%s: %zu scans, %.0f m by dead reckoning, %zu stamps mended\n", name,
                set.raw.scans.size(), set.odometry.length(), set.mended);
    print("dead reckoning", evaluate(set, set.odometry));
    if (set.corrected) {
      std::vector<StampedPose> poses;
      const double offset = clock_offset(set.raw, set.clock, *set.corrected).value_or(0.0);
      for (const OdomRecord& record : set.corrected->odometry)
        poses.push_back({record.time.ipc + offset, record.pose});
      print("corrected file", evaluate(set, Trajectory(std::move(poses))));
      print("corrected file's scans", evaluate(set, densify(*set.reference, set.odometry)));
    }
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    registration::ScanMapper mapper;
    for (const LaserScan& scan : set.raw.scans) {
      registration::Beams beams;
      beams.first_angle = scan.first_angle;
      beams.step = scan.step;
      beams.sensor_in_robot = scan.laser_in_robot;
      beams.max_range = std::min(20.0, scan.no_return);
      mapper.add(scan.pose, registration::make_scan(scan.ranges, beams));
    }
    const auto& r = mapper.report();
    std::printf("  %.1f s: %zu nodes, %zu searches, %zu unmatched, %zu candidates, %zu loops\n",
                seconds(), r.nodes, r.searches, r.unmatched, r.loop_candidates, r.loops);
    print("full ranges, as it drove", evaluate(set, scan_times(set, mapper.trajectory())));
    for (int round = 1; round <= 4; ++round) {
      mapper.refine(1);
      print("full ranges, refined", evaluate(set, scan_times(set, mapper.trajectory())));
      std::printf("  %.1f s\n", seconds());
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Registration on logs of real robots"};
  bool as_json = false;
  std::string data;
  app.add_flag("--json", as_json, "one JSON object on the last line");
  app.add_option("--data", data, "the folder of the data sets")->envname("SAPHIRA_DATA");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(data);
  } catch (const std::exception& error) {
    std::cerr << "saphira-bench-registration: " << error.what() << '\n';
    return 2;
  }
}
