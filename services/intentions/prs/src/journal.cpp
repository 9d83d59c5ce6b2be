#include "saphira/intentions/journal.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>
#include <utility>

#include "saphira/base/durable.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"

namespace saphira::intentions {
namespace {

std::string write_id(const GoalId& id) {
  char text[48];
  std::snprintf(text, sizeof text, "%llx %llu", static_cast<unsigned long long>(id.writer),
                static_cast<unsigned long long>(id.number));
  return text;
}

/// A whole word as a number to the base; otherwise an error at that word.
std::uint64_t read_count(LineReader& reader, std::string_view what, int base) {
  const std::string_view word = reader.word(what);
  const auto value = number_in<std::uint64_t>(word, base);
  if (!value)
    reader.fail("expected " + std::string(what) + ", found \"" + std::string(word) + "\"");
  return *value;
}

GoalId read_id(LineReader& reader) {
  GoalId id;
  id.writer = read_count(reader, "the goal's writer, in hexadecimal digits", 16);
  id.number = read_count(reader, "the goal's number", 10);
  return id;
}

constexpr std::pair<GoalCode, std::string_view> kCodes[] = {
    {v1::CODE_NONE, "none"},
    {v1::CODE_UNKNOWN_FUNCTOR, "unknown_functor"},
    {v1::CODE_BAD_ARGUMENT, "bad_argument"},
    {v1::CODE_CHANGED, "changed"},
    {v1::CODE_TOO_MANY, "too_many"},
    {v1::CODE_FORGOTTEN, "forgotten"},
    {v1::CODE_DEADLINE, "deadline"},
    {v1::CODE_BLOCKED, "blocked"},
    {v1::CODE_NO_ROBOT, "no_robot"},
    {v1::CODE_NO_POSITION, "no_position"},
    {v1::CODE_NO_ROUTE, "no_route"},
    {v1::CODE_ACTIVITY, "activity"},
    {v1::CODE_TIMEOUT, "timeout"},
    {v1::CODE_DISPOSED, "disposed"},
    {v1::CODE_WRITER_LOST, "writer_lost"},
    {v1::CODE_PREEMPTED, "preempted"},
    {v1::CODE_STOPPED, "stopped"},
};
constexpr std::pair<GoalState, std::string_view> kEnds[] = {
    {v1::GOAL_SUCCEEDED, "succeeded"},
    {v1::GOAL_FAILED, "failed"},
    {v1::GOAL_CANCELED, "canceled"},
    {v1::GOAL_REFUSED, "refused"},
};

/// A value without a name, which is none of an ending, is written as "?".
template <class Names, class Value>
std::string name_in(const Names& names, Value value) {
  const auto* const found = std::find_if(std::begin(names), std::end(names),
                                         [&](const auto& each) { return each.first == value; });
  return found == std::end(names) ? "?" : std::string(found->second);
}

template <class Names>
auto read_name(LineReader& reader, const Names& names, std::string_view what) {
  const std::string_view word = reader.word(what);
  const auto* const found = std::find_if(std::begin(names), std::end(names),
                                         [&](const auto& each) { return each.second == word; });
  if (found == std::end(names))
    reader.fail("expected " + std::string(what) + ", found \"" + std::string(word) + "\"");
  return found->first;
}

Pose read_pose(LineReader& reader) {
  Pose pose;
  pose.x = reader.number("x [m]");
  pose.y = reader.number("y [m]");
  pose.th = reader.number("th [rad]");
  return pose;
}

Ending read_ending(LineReader& reader, const Line& line) {
  Ending ending;
  ending.id = read_id(reader);
  ending.state = read_name(reader, kEnds, "the state at the end, such as succeeded");
  ending.code = read_name(reader, kCodes, "a code, such as none");
  // A reason is free text: the rest of the line.
  const std::string_view code = line.words.at(4).text;
  const auto begin = static_cast<std::size_t>(code.data() + code.size() - line.text.data());
  ending.reason = line.text.substr(std::min(begin + 1, line.text.size()));
  return ending;
}

/// The rest of the line, behind the id.
void read_placement(LineReader& reader, Placement& placement) {
  placement.epoch = read_count(reader, "the epoch of acceptance", 10);
  placement.cycle = read_count(reader, "the cycle of acceptance", 10);
  placement.odom = read_count(reader, "the number of the odom frame", 10);
  while (!reader.at_end()) {
    Placement::Point point;
    point.name = reader.word("the name of a point");
    point.given = read_pose(reader);
    point.in_odom = read_pose(reader);
    placement.points.push_back(std::move(point));
  }
}

void read_line(const std::string& file, int number, std::string_view text,
               std::map<GoalId, Placement>& placements, std::vector<Ending>& endings) {
  const std::vector<Line> lines = split_lines(text);
  if (lines.size() != 1)
    throw FileError(file, number, 1, "expected \"placed\" or \"ended\"", text);
  Line line = lines.front();
  line.number = number;
  LineReader reader(file, line);
  const std::string_view kind = reader.word("\"placed\" or \"ended\"");
  if (kind == "placed") {
    Placement placement;
    placement.id = read_id(reader);
    read_placement(reader, placement);
    placements[placement.id] = std::move(placement);
  } else if (kind == "ended") {
    Ending ending = read_ending(reader, line);
    placements.erase(ending.id);
    endings.push_back(std::move(ending));
  } else {
    reader.fail("expected \"placed\" or \"ended\", found \"" + std::string(kind) + "\"");
  }
}

}  // namespace

std::string write_line(const Ending& ending) {
  std::string reason = ending.reason;
  std::replace_if(
      reason.begin(), reason.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; },
      ' ');
  return sealed_line("ended " + write_id(ending.id) + " " + name_in(kEnds, ending.state) + " " +
                     name_in(kCodes, ending.code) + " " + reason) +
         "\n";
}

std::string write_line(const Placement& placement) {
  std::string line = "placed " + write_id(placement.id) + " " + std::to_string(placement.epoch) +
                     " " + std::to_string(placement.cycle) + " " + std::to_string(placement.odom);
  for (const Placement::Point& point : placement.points) {
    line += " " + point.name;
    for (const Pose& pose : {point.given, point.in_odom})
      line += " " + exact(pose.x) + " " + exact(pose.y) + " " + exact(pose.th);
  }
  return sealed_line(line) + "\n";
}

Memory read_journal(const std::string& file, std::string_view content,
                    std::vector<FileError>& damaged) {
  std::map<GoalId, Placement> placements;
  std::vector<Ending> endings;
  int number = 0;
  while (!content.empty()) {
    const std::size_t end = content.find('\n');
    if (end == std::string_view::npos) {
      damaged.emplace_back(file, number + 1, 1, "the file ends within this line", content);
      break;
    }
    const std::string_view text = content.substr(0, end);
    content.remove_prefix(end + 1);
    ++number;
    try {
      const std::optional<std::string_view> line = unsealed_line(text);
      if (!line)
        throw FileError(file, number, 1, "the line is not as it was written: its sum is wrong",
                        text);
      read_line(file, number, *line, placements, endings);
    } catch (const FileError& error) {
      damaged.push_back(error);
    }
  }
  Memory memory;
  for (auto& [id, placement] : placements)
    memory.placements.push_back(std::move(placement));
  memory.endings = std::move(endings);
  return memory;
}

}  // namespace saphira::intentions
