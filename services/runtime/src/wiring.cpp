#include "saphira/runtime/wiring.hpp"

#include <algorithm>
#include <cstdio>

#include "saphira/base/text.hpp"

namespace saphira::runtime {
namespace {

Line& line_of(std::vector<Line>& lines, const std::string& topic) {
  const auto found = std::find_if(lines.begin(), lines.end(),
                                  [&](const Line& line) { return line.topic == topic; });
  return found != lines.end() ? *found : lines.emplace_back(Line{topic, {}, {}});
}

std::string names(const std::vector<Line::End>& ends, const std::vector<Unit>& units) {
  const std::string text = joined(ends, ", ", [&](const Line::End& end) {
    return units[end.unit].name + " (" + word(end.use) + ")";
  });
  return text.empty() ? "-" : text;
}

// The drawing, in pixels.
constexpr int kLeft = 200;    // the names of topics
constexpr int kTop = 60;      // the names of units
constexpr int kColumn = 110;  // between two units
constexpr int kRow = 24;      // between two topics
constexpr int kLegend = 50;

int x_of(std::size_t unit) {
  return kLeft + kColumn / 2 + kColumn * static_cast<int>(unit);
}
int y_of(std::size_t line) {
  return kTop + kRow / 2 + kRow * static_cast<int>(line);
}

std::string text_at(int x, int y, const char* anchor, const std::string& text) {
  return "<text x=\"" + std::to_string(x) + "\" y=\"" + std::to_string(y) + "\" text-anchor=\"" +
         anchor + "\">" + text + "</text>\n";
}

std::string stroke(int x1, int y1, int x2, int y2, const char* color) {
  return "<line x1=\"" + std::to_string(x1) + "\" y1=\"" + std::to_string(y1) + "\" x2=\"" +
         std::to_string(x2) + "\" y2=\"" + std::to_string(y2) + "\" stroke=\"" + color + "\"/>\n";
}
std::string dot(int x, int y, const char* fill) {
  return "<circle cx=\"" + std::to_string(x) + "\" cy=\"" + std::to_string(y) +
         "\" r=\"6\" stroke=\"#333\" stroke-width=\"1.5\" fill=\"" + fill + "\"/>\n";
}

constexpr const char* kWrites = "#333";
constexpr const char* kReadsCycle = "#fff";
constexpr const char* kReadsOther = "#9bc";

const char* fill_of(Port::Use use) {
  if (use == Port::Use::kState || use == Port::Use::kCycle)
    return kReadsCycle;
  return use == Port::Use::kNewest || use == Port::Use::kEvents ? kReadsOther : kWrites;
}

std::string row(const Line& line, int y) {
  std::string text = text_at(kLeft - 10, y + 4, "end", line.topic);
  std::vector<Line::End> ends = line.writers;
  ends.insert(ends.end(), line.readers.begin(), line.readers.end());
  const auto [first, last] =
      std::minmax_element(ends.begin(), ends.end(),
                          [](const Line::End& a, const Line::End& b) { return a.unit < b.unit; });
  text += stroke(x_of(first->unit), y, x_of(last->unit), y, "#333");
  for (const Line::End& end : ends)
    text += dot(x_of(end.unit), y, fill_of(end.use));
  return text;
}

std::string legend(int y) {
  std::string text;
  int x = kLeft - 10;
  const auto entry = [&](const char* fill, const char* words, int width) {
    text += dot(x, y - 4, fill) + text_at(x + 12, y, "start", words);
    x += width;
  };
  entry(kWrites, "writes", 80);
  entry(kReadsCycle, "reads in step: robot/state of cycle N, the others of N-1", 380);
  entry(kReadsOther, "reads what has come", 0);
  return text;
}

}  // namespace

std::vector<Line> lines_of(const std::vector<Unit>& units) {
  std::vector<Line> lines;
  for (const bool inputs : {false, true})
    for (std::size_t i = 0; i < units.size(); ++i)
      for (const Port& port : units[i].ports)
        if (port.is_input() == inputs) {
          Line& line = line_of(lines, port.topic);
          (inputs ? line.readers : line.writers).push_back({i, port.use});
        }
  return lines;
}

std::string wiring_table(const std::vector<Unit>& units) {
  std::string text = "| topic | written by | read by |\n|---|---|---|\n";
  for (const Line& line : lines_of(units))
    text += "| " + line.topic + " | " + names(line.writers, units) + " | " +
            names(line.readers, units) + " |\n";
  return text;
}

std::string wiring_text(const std::vector<Unit>& units) {
  const std::vector<Line> lines = lines_of(units);
  std::size_t width = 0;
  for (const Line& line : lines)
    width = std::max(width, line.topic.size());
  std::string text;
  for (const Line& line : lines) {
    text += line.topic + std::string(width - line.topic.size() + 2, ' ') +
            (line.writers.empty() ? "from outside" : names(line.writers, units));
    if (!line.readers.empty())
      text += " -> " + names(line.readers, units);
    text += "\n";
  }
  return text;
}

std::string wiring_drawing(const std::vector<Unit>& units) {
  const std::vector<Line> lines = lines_of(units);
  const int width = std::max(kLeft + kColumn * static_cast<int>(units.size()), 800);
  const int bottom = kTop + kRow * static_cast<int>(lines.size());
  char head[160];
  std::snprintf(head, sizeof head,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
                "font-family=\"sans-serif\" font-size=\"12\">\n",
                width, bottom + kLegend);
  std::string text = head;
  text += "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  for (std::size_t i = 0; i < units.size(); ++i) {
    text += text_at(x_of(i), kTop - 20, "middle", units[i].name);
    text += stroke(x_of(i), kTop - 10, x_of(i), bottom, "#ccc");
  }
  for (std::size_t i = 0; i < lines.size(); ++i)
    text += row(lines[i], y_of(i));
  return text + legend(bottom + kLegend / 2) + "</svg>\n";
}

}  // namespace saphira::runtime
