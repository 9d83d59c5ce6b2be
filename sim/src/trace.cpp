#include "saphira/sim/trace.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "saphira/base/format.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"

namespace saphira::sim {

namespace {

constexpr std::size_t kColumns = 11;

constexpr int kRowsBetweenOutlines = 50;  // of a picture: 5 s

// A number of a trace: unlike numbers in people's files it may be nan or inf.
double trace_number(std::string_view text, const std::string& file, int line, int column,
                    std::string_view whole) {
  const auto value = number_in<double>(text);
  if (!value)
    throw FileError(file, line, column, "expected a number, found \"" + std::string(text) + "\"",
                    whole);
  return *value;
}

void outline(std::string& out, const Pose& at, double height, double radius, const char* style) {
  out += format(
      "<g transform=\"translate(%.1f %.1f) rotate(%.1f)\" %s><circle r=\"%.1f\"/>"
      "<path d=\"M 0 0 H %.1f\"/></g>\n",
      at.x * 1000.0, (height - at.y) * 1000.0, -degrees(at.th), style, radius * 1000.0,
      radius * 1000.0);
}

}  // namespace

std::string trace_header() {
  return "cycle,x,y,th,velocity,rotation_velocity,set_velocity,set_heading,set_rotation_velocity,"
         "clearance,contacts\n";
}

std::string to_csv(const TraceRow& row) {
  return format("%llu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%d\n",
                static_cast<unsigned long long>(row.cycle), row.pose_in_world.x,
                row.pose_in_world.y, row.pose_in_world.th, row.velocity, row.rotation_velocity,
                row.set_velocity, row.set_heading, row.set_rotation_velocity, row.clearance,
                row.contacts);
}

std::vector<TraceRow> parse_trace(std::string_view text, const std::string& file) {
  std::string header = trace_header();
  header.pop_back();
  std::vector<TraceRow> rows;
  bool first = false;
  int number = 0;
  while (true) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos)
      return rows;
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    ++number;
    if (line == header) {
      first = true;
      continue;
    }
    if (number == 1)
      throw FileError(file, 1, 1, "expected the header line of a trace", line);
    std::array<double, kColumns> values{};
    std::size_t begin = 0;
    for (std::size_t i = 0; i < kColumns; ++i) {
      const std::size_t comma = std::min(line.find(',', begin), line.size());
      if (begin > line.size() || (i + 1 < kColumns) == (comma == line.size()))
        throw FileError(file, number, 1, "expected 11 numbers with commas between them", line);
      values[i] = trace_number(line.substr(begin, comma - begin), file, number,
                               static_cast<int>(begin) + 1, line);
      begin = comma + 1;
    }
    if (!(values[0] >= 0.0 && values[0] < 1e15) || !(std::abs(values[10]) < 1e9))
      throw FileError(file, number, 1, "expected a cycle and a number of contacts", line);
    rows.push_back({first,
                    static_cast<std::uint64_t>(values[0]),
                    {values[1], values[2], values[3]},
                    values[4],
                    values[5],
                    values[6],
                    values[7],
                    values[8],
                    values[9],
                    static_cast<int>(values[10])});
    first = false;
  }
}

std::string plot_svg(const World& world, const std::vector<TraceRow>& trace, double radius) {
  const double height = world.height;
  std::string out;
  out += format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-300 -300 %.0f %.0f\" "
      "width=\"1200\">\n<rect x=\"-300\" y=\"-300\" width=\"100%%\" height=\"100%%\" "
      "fill=\"#ffffff\"/>\n",
      world.width * 1000.0 + 600.0, height * 1000.0 + 600.0);
  out += "<path fill=\"none\" stroke=\"#30343b\" stroke-width=\"50\" stroke-linecap=\"round\" d=\"";
  for (const Segment& s : world.segments)
    out += format("M%.0f %.0fL%.0f %.0f", s.from.x() * 1000.0, (height - s.from.y()) * 1000.0,
                  s.to.x() * 1000.0, (height - s.to.y()) * 1000.0);
  out += "\"/>\n";
  if (trace.empty())
    return out + "</svg>\n";
  out +=
      "<path fill=\"none\" stroke=\"#1f77b4\" stroke-width=\"60\" stroke-linejoin=\"round\" d=\"";
  for (const TraceRow& row : trace)
    out += format("%s%.0f %.0f", row.first || &row == &trace.front() ? "M" : "L",
                  row.pose_in_world.x * 1000.0, (height - row.pose_in_world.y) * 1000.0);
  out += "\"/>\n";
  for (std::size_t i = kRowsBetweenOutlines; i + 1 < trace.size(); i += kRowsBetweenOutlines)
    outline(out, trace[i].pose_in_world, height, radius,
            "fill=\"none\" stroke=\"#9ec5e6\" stroke-width=\"25\"");
  outline(out, trace.front().pose_in_world, height, radius,
          "fill=\"#cfe8cf\" stroke=\"#2a7d2a\" stroke-width=\"40\"");
  outline(out, trace.back().pose_in_world, height, radius,
          "fill=\"#f6d2b3\" stroke=\"#c8580f\" stroke-width=\"40\"");
  int contacts = trace.front().contacts;
  for (const TraceRow& row : trace) {
    if (row.contacts != contacts)
      out += format("<circle cx=\"%.0f\" cy=\"%.0f\" r=\"120\" fill=\"#d62728\"/>\n",
                    row.pose_in_world.x * 1000.0, (height - row.pose_in_world.y) * 1000.0);
    contacts = row.contacts;
  }
  return out + "</svg>\n";
}

}  // namespace saphira::sim
