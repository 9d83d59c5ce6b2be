#include "saphira/cli/trace.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "saphira/base/fnv1a.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"

namespace saphira::cli {

namespace {

/// The used columns of a trace, and the number of all.
enum Column : std::size_t { kCycle = 0, kX = 1, kY = 2, kClearance = 9, kContacts = 10 };
constexpr std::size_t kColumns = 11;
constexpr std::string_view kHeader = "cycle,";

using Row = std::array<double, kColumns>;

Row parse_row(std::string_view line, int number, const std::string& file) {
  Row row{};
  std::size_t at = 0;
  for (std::size_t i = 0; i < kColumns; ++i) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    const std::string field(line.substr(at, end - at));
    char* stopped = nullptr;
    row[i] = std::strtod(field.c_str(), &stopped);
    const bool last = i + 1 == kColumns;
    if (field.empty() || *stopped != '\0' || last != (end == line.size()))
      throw FileError(file, number, static_cast<int>(at) + 1,
                      "expected " + std::to_string(kColumns) + " numbers of a trace", line);
    at = end + 1;
  }
  return row;
}

}  // namespace

Track evaluate_trace(std::string_view text, std::uint64_t last_cycle, const std::string& file) {
  Track track;
  track.min_clearance = std::numeric_limits<double>::quiet_NaN();
  const std::size_t newest = text.rfind(kHeader);
  Fnv1a hash;
  bool first = true;
  double x = 0.0;
  double y = 0.0;
  std::uint64_t counted = 0;
  std::uint64_t before = 0;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos)
      break;
    const std::string_view line = text.substr(at, end - at);
    const bool of_newest = newest == std::string_view::npos || at > newest;
    at = end + 1;
    ++number;
    if (line.starts_with(kHeader))
      continue;
    const Row row = parse_row(line, number, file);
    if (of_newest && row[kCycle] > static_cast<double>(last_cycle))
      break;
    if (!first)
      track.path += std::hypot(row[kX] - x, row[kY] - y);
    first = false;
    x = row[kX];
    y = row[kY];
    track.min_clearance = std::fmin(track.min_clearance, row[kClearance]);
    const auto count = static_cast<std::uint64_t>(row[kContacts]);
    if (count < counted)  // the simulator was restarted
      before += counted;
    counted = count;
    track.contacts = before + counted;
    if (of_newest)
      track.cycles = static_cast<std::uint64_t>(row[kCycle]);
    hash.add(line);
    hash.add("\n");
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
