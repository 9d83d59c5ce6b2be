#include "saphira/cli/trace.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "saphira/base/fnv1a.hpp"
#include "saphira/base/format.hpp"
#include "saphira/sim/trace.hpp"

namespace saphira::cli {

Track evaluate_trace(std::string_view text, std::uint64_t last_cycle, const std::string& file) {
  const std::vector<sim::TraceRow> rows = sim::parse_trace(text, file);
  std::size_t newest = 0;  // connection
  for (std::size_t i = 0; i < rows.size(); ++i)
    newest = rows[i].first ? i : newest;
  Track track;
  track.min_clearance = std::numeric_limits<double>::quiet_NaN();
  Fnv1a hash;
  std::uint64_t counted = 0;
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const sim::TraceRow& row = rows[i];
    if (i >= newest && row.cycle > last_cycle)
      break;
    if (i > 0)
      track.path += (row.pose_in_world.position() - rows[i - 1].pose_in_world.position()).norm();
    track.min_clearance = std::fmin(track.min_clearance, row.clearance);
    const auto count = static_cast<std::uint64_t>(row.contacts);
    if (count < counted)  // the simulator was restarted
      before += counted;
    counted = count;
    track.contacts = before + counted;
    if (i >= newest)
      track.cycles = row.cycle;
    hash.add(sim::to_csv(row));
  }
  track.hash = hash.text();
  return track;
}

std::string to_json(const Summary& summary) {
  const auto rounded = [](double value, double per) { return std::round(value * per) / per; };
  nlohmann::ordered_json json;
  json["arrived"] = summary.arrived;
  json["time_s"] = rounded(summary.time, 10.0);
  json["path_m"] = rounded(summary.track.path, 1000.0);
  json["min_clearance_m"] = rounded(summary.track.min_clearance, 1000.0);
  json["contacts"] = summary.track.contacts;
  json["cycles"] = summary.track.cycles;
  json["late_cycles"] = summary.late_cycles;
  json["trajectory_hash"] = summary.track.hash;
  json["speed_factor"] = rounded(summary.speed_factor, 100.0);
  return json.dump();
}

std::string to_text(const Summary& summary) {
  return format(
      "time                %.1f s%s\n"
      "path                %.2f m\n"
      "smallest clearance  %.2f m\n"
      "contacts            %llu\n"
      "cycles              %llu, %llu late\n",
      summary.time,
      summary.speed_factor > 0.0 ? format(" (%.2f x real time)", summary.speed_factor).c_str() : "",
      summary.track.path, summary.track.min_clearance,
      static_cast<unsigned long long>(summary.track.contacts),
      static_cast<unsigned long long>(summary.track.cycles),
      static_cast<unsigned long long>(summary.late_cycles));
}

}  // namespace saphira::cli
