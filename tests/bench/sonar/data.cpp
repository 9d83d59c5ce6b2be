#include "data.hpp"

#include <cmath>

#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"

namespace saphira::bench {

namespace {

struct Cell {
  std::string_view text;
  int column = 1;
};

struct Row {
  std::string_view line;
  int number = 1;
  std::vector<Cell> cells;
};

// The lines of a text with their cells; empty lines are left out.
std::vector<Row> rows_of(std::string_view text, char separator) {
  std::vector<Row> rows;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    Row row{text.substr(0, end), number, {}};
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (!row.line.empty() && row.line.back() == '\r')
      row.line.remove_suffix(1);
    for (std::size_t at = 0; at <= row.line.size() && !row.line.empty();) {
      const std::size_t next = std::min(row.line.find(separator, at), row.line.size());
      if (separator != ' ' || next > at)
        row.cells.push_back({row.line.substr(at, next - at), static_cast<int>(at) + 1});
      at = next + 1;
    }
    if (!row.cells.empty())
      rows.push_back(std::move(row));
  }
  return rows;
}

double number(const Row& row, std::size_t cell, const std::string& file) {
  if (cell >= row.cells.size())
    throw FileError(file, row.number, static_cast<int>(row.line.size()) + 1, "expected a number",
                    row.line);
  const auto value = number_in<double>(row.cells[cell].text);
  if (!value || !std::isfinite(*value))
    throw FileError(file, row.number, row.cells[cell].column, "expected a number", row.line);
  return *value;
}

}  // namespace

std::vector<Calibration> parse_calibration(std::string_view csv, const std::string& column,
                                           const std::string& file) {
  const auto rows = rows_of(csv, ',');
  const auto find = [&](const std::string& name) {
    if (!rows.empty())
      for (std::size_t i = 0; i < rows[0].cells.size(); ++i)
        if (rows[0].cells[i].text == name)
          return i;
    throw FileError(file, 1, 1, "expected a column \"" + name + "\"");
  };
  const std::size_t truth = find("range");
  const std::size_t reading = find(column);
  std::vector<Calibration> out;
  for (std::size_t i = 1; i < rows.size(); ++i)
    out.push_back({number(rows[i], truth, file), number(rows[i], reading, file)});
  return out;
}

std::vector<CorridorRecord> parse_corridor(std::string_view measurements, std::string_view poses,
                                           const std::string& folder) {
  const std::string measurement_file = folder + "/measurement.txt";
  const std::string pose_file = folder + "/poses.txt";
  const auto readings = rows_of(measurements, ' ');
  const auto places = rows_of(poses, ' ');
  if (readings.size() != places.size())
    throw FileError(pose_file, 1, 1, "expected as many lines as in measurement.txt");
  std::vector<CorridorRecord> out;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (number(readings[i], 0, measurement_file) != number(places[i], 0, pose_file))
      throw FileError(pose_file, places[i].number, 1, "expected the time of measurement.txt",
                      places[i].line);
    CorridorRecord record;
    record.pose_in_odom = {number(places[i], 1, pose_file) * 0.001,
                           number(places[i], 2, pose_file) * 0.001,
                           norm2_angle(radians(number(places[i], 3, pose_file) * 0.1))};
    for (std::size_t k = 0; k < 8; ++k)
      record.ranges[k] = number(readings[i], k + 1, measurement_file) * 0.001;
    out.push_back(record);
  }
  return out;
}

std::vector<std::array<double, kRing>> parse_ring(std::string_view csv, const std::string& file) {
  std::vector<std::array<double, kRing>> out;
  for (const Row& row : rows_of(csv, ',')) {
    if (row.number == 1 && row.cells[0].text.starts_with("S"))
      continue;  // the header
    std::array<double, kRing> ring{};
    for (std::size_t k = 0; k < kRing; ++k)
      ring[k] = number(row, k, file);
    out.push_back(ring);
  }
  return out;
}

}  // namespace saphira::bench
