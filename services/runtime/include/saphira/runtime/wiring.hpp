#pragma once

#include <string>
#include <vector>

#include "saphira/runtime/ports.hpp"

namespace saphira::runtime {

/// A program in the system's table: its name, its purpose, its topics.
struct Unit {
  std::string name;
  std::string effect;
  std::vector<Port> ports;
};

/// A topic in the table: its writers and readers, by their index among the units.
struct Line {
  struct End {
    std::size_t unit = 0;
    Port::Use use = Port::Use::kEach;
  };
  std::string topic;
  std::vector<End> writers;
  std::vector<End> readers;
};

/// The topics of the units, in the order of their first use as an output; then those that no unit
/// writes.
std::vector<Line> lines_of(const std::vector<Unit>& units);

/// The table in Markdown: a row for each topic, with its writers and readers.
std::string wiring_table(const std::vector<Unit>& units);
/// The same for a terminal.
std::string wiring_text(const std::vector<Unit>& units);
/// The same as a drawing (SVG): a column for each unit, a row for each topic.
std::string wiring_drawing(const std::vector<Unit>& units);

}  // namespace saphira::runtime
