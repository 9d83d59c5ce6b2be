#include "saphira/logs/data_set.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "saphira/logs/stamps.hpp"

namespace saphira::logs {

namespace {

namespace fs = std::filesystem;

constexpr double kLaserReach = 20.0;  // [m]

std::string first_of(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  return names.empty() ? "" : names.front();
}

// Of several files the one whose name begins like the log's: with the whole first word.
std::string like(const std::vector<std::string>& paths, const std::string& log) {
  std::vector<std::string> out;
  const std::string word = log.substr(0, log.find_first_of(".-_"));
  for (const std::string& path : paths)
    if (fs::path(path).filename().string().starts_with(word))
      out.push_back(path);
  return first_of(out);
}

}  // namespace

std::vector<LogFiles> find_logs(const std::string& folder) {
  std::vector<std::string> folders;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_directory())
      folders.push_back(entry.path().string());
  folders.push_back(folder);
  std::sort(folders.begin(), folders.end());
  std::vector<LogFiles> out;
  for (const std::string& each : folders) {
    std::vector<std::string> logs;
    std::vector<std::string> corrected;
    std::vector<std::string> relations;
    for (const auto& entry : fs::directory_iterator(each)) {
      if (!entry.is_regular_file())
        continue;
      const std::string name = entry.path().filename().string();
      const auto has = [&](const char* part) { return name.find(part) != std::string::npos; };
      if (has(".relations"))
        relations.push_back(entry.path().string());
      else if (has("correct") || has(".gfs"))
        corrected.push_back(entry.path().string());
      else if (has(".log") || has(".clf") || has(".carmen"))
        logs.push_back(entry.path().string());
    }
    std::sort(logs.begin(), logs.end());
    for (const std::string& log : logs) {
      const bool alone = logs.size() == 1;
      const fs::path path(log);
      const std::string name = path.filename().string();
      out.push_back({alone && each != folder ? path.parent_path().filename().string()
                                             : name.substr(0, name.find('.')),
                     log, alone ? first_of(corrected) : like(corrected, name),
                     alone ? first_of(relations) : like(relations, name)});
    }
  }
  return out;
}

DataSet data_set_of(const std::string& name, const CarmenLog& log, Clock clock) {
  DataSet set;
  set.name = name;
  set.damaged = log.damaged;
  for (const LaserScan& scan : log.scans) {
    set.times.push_back(time_of(scan.time, clock));
    set.poses_in_odom.push_back(scan.pose);
    Beams beams;
    beams.first_angle = scan.first_angle;
    beams.step = scan.step;
    beams.sensor_in_robot = scan.laser_in_robot;
    beams.max_range = std::min(kLaserReach, scan.no_return);
    set.scans.push_back(make_scan(scan.ranges, beams));
  }
  set.odometry = time_base(log, clock).odometry;
  return set;
}

DataSet load_data_set(const std::string& name, const LogFiles& files) {
  std::vector<std::string> notes;
  const auto log_of = [&](const std::string& path) {
    std::string trouble;
    CarmenLog log = parse_carmen(read_log(path, &trouble), path);
    if (!trouble.empty())
      notes.push_back(trouble);
    return log;
  };
  CarmenLog raw = log_of(files.raw);
  notes.insert(notes.end(), raw.notes.begin(), raw.notes.end());
  std::optional<CarmenLog> corrected;
  if (!files.corrected.empty())
    corrected = log_of(files.corrected);
  if (corrected) {
    raw.damaged.insert(raw.damaged.end(), corrected->damaged.begin(), corrected->damaged.end());
    notes.insert(notes.end(), corrected->notes.begin(), corrected->notes.end());
  }
  std::vector<Relation> relations;
  if (!files.relations.empty())
    relations = parse_relations(read_log(files.relations), files.relations);

  // The clock of the relations' stamps, or of the corrected file.
  Clock clock = Clock::ipc;
  const auto hits = [&](Clock by) {
    const Trajectory track = time_base(raw, by).odometry;
    return std::count_if(relations.begin(), relations.end(),
                         [&](const Relation& r) { return track.at(r.from) && track.at(r.to); });
  };
  if (!relations.empty()) {
    if (hits(Clock::logger) > hits(Clock::ipc))
      clock = Clock::logger;
  } else if (corrected) {
    const auto ipc = clock_offset(raw, Clock::ipc, *corrected);
    const auto logger = clock_offset(raw, Clock::logger, *corrected);
    if (ipc && logger && std::abs(*logger) < std::abs(*ipc))
      clock = Clock::logger;
  }
  // A clock that was set back hides earlier scans; the other clock may be sound.
  if (const auto other = clock == Clock::ipc ? Clock::logger : Clock::ipc;
      relations.empty() && !corrected && steps_back(raw, clock) > 0 && steps_back(raw, other) == 0)
    clock = other;
  if (const std::size_t back = steps_back(raw, clock); back > 0)
    notes.push_back(std::to_string(back) +
                    " scans are stamped seconds before the scan that stands before them");
  // The mark of scans in a merge of thinned logs: their stamps are interpolated.
  const auto interpolated = [](const LaserScan& scan) { return scan.host == "A"; };
  const bool mend = corrected && raw.odometry.empty() &&
                    std::any_of(raw.scans.begin(), raw.scans.end(), interpolated);
  std::optional<TimeBase> mended;
  if (mend)
    mended = mend_stamps(raw, *corrected);
  else
    std::stable_sort(raw.scans.begin(), raw.scans.end(),
                     [&](const LaserScan& a, const LaserScan& b) {
                       return time_of(a.time, clock) < time_of(b.time, clock);
                     });
  DataSet set = data_set_of(name, raw, clock);
  if (mended) {
    set.odometry = std::move(mended->odometry);
    set.mended = mended->mended;
  }
  set.notes = std::move(notes);
  set.relations = std::move(relations);

  std::set<double> stamps;
  for (std::size_t i = 0; i < raw.scans.size(); ++i)
    if (!mend || !interpolated(raw.scans[i]))
      stamps.insert(set.times[i]);
  const auto known = [&](double stamp) {
    const auto it = stamps.lower_bound(stamp - 5e-6);
    return it != stamps.end() && *it < stamp + 5e-6;
  };
  for (const Relation& relation : set.relations)
    if (known(relation.from) && known(relation.to))
      set.exact_relations.push_back(relation);

  std::vector<StampedPose> poses;
  if (corrected) {
    const auto offset = clock_offset(raw, clock, *corrected);
    if (!offset)
      set.notes.emplace_back(
          "no scan is in the corrected file too: its clock is taken to be the log's");
    for (const LaserScan& scan : corrected->scans)
      poses.push_back({scan.time.ipc + offset.value_or(0.0), scan.pose});
  } else {
    for (const OdomRecord& record : raw.truth)
      poses.push_back({time_of(record.time, clock), record.pose});
  }
  if (!poses.empty())
    set.reference.emplace(std::move(poses));
  if (set.reference && pair_up(set.odometry, *set.reference).reference.size() < 2) {
    set.notes.emplace_back("the reference is of another time than the log and is left out");
    set.reference.reset();
  }
  const auto strange = std::count_if(
      set.relations.begin(), set.relations.end(),
      [&](const Relation& r) { return !set.odometry.at(r.from) || !set.odometry.at(r.to); });
  if (strange > 0)
    set.notes.push_back(std::to_string(strange) + " of " + std::to_string(set.relations.size()) +
                        " relations are of times that are not in the log");
  return set;
}

SonarDrive virtual_drive(const DataSet& set, std::vector<lps::SonarMount> mounts) {
  SonarDrive drive;
  drive.ring.mounts = std::move(mounts);
  drive.times = set.times;
  drive.poses_in_odom = set.poses_in_odom;
  drive.at_once = true;
  for (const logs::Scan& scan : set.scans)
    drive.readings.push_back(hear(scan, drive.ring));
  return drive;
}

}  // namespace saphira::logs
