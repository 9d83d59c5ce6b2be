#include "saphira/intentions/work.hpp"

#include <charconv>
#include <cstdio>

#include "saphira/base/text.hpp"
#include "saved.hpp"

namespace saphira::intentions {
namespace {

// A whole number of 64 bits is a text: a number of the language does not hold them all.
std::string whole(std::uint64_t number) {
  char text[24];
  std::snprintf(text, sizeof text, "x%llx", static_cast<unsigned long long>(number));
  return text;
}

std::uint64_t read_whole(const std::string& text) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  if (text.empty() || text.front() != 'x' ||
      std::from_chars(text.data() + 1, end, number, 16).ptr != end)
    throw ActivityError("expected a whole number in hexadecimal digits behind an x, found \"" +
                        text + "\"");
  return number;
}

template <class... T>
std::string line(const std::string& kind, const T&... fields) {
  Saving out;
  out(kind, fields...);
  return to_text(out.value()) + "\n";
}

void read_line(const Value& line, Work& work) {
  Loading in(line);
  std::string kind;
  std::string first;
  std::string second;
  in(kind);
  if (kind == "at") {
    std::string odom;
    in(first, second, odom, work.now);
    work.epoch = read_whole(first);
    work.cycle = read_whole(second);
    work.odom = read_whole(odom);
  } else if (kind == "goal") {
    GoalWork& goal = work.goals.emplace_back();
    in(first, second, goal.functor, goal.intentions);
    goal.id.writer = read_whole(first);
    goal.id.number = read_whole(second);
  } else if (kind == "belief") {
    Belief& belief = work.beliefs.emplace_back();
    in(belief.name, belief.value, belief.said_by, belief.since);
  } else if (kind == "heeds") {
    in(first, second);
    work.heeds = {read_whole(first), read_whole(second)};
  } else {
    throw ActivityError("expected \"at\", \"goal\", \"belief\" or \"heeds\"");
  }
}

}  // namespace

std::string write_work(const Work& work) {
  std::string text = line("at", whole(work.epoch), whole(work.cycle), whole(work.odom), work.now);
  for (const GoalWork& goal : work.goals)
    text +=
        line("goal", whole(goal.id.writer), whole(goal.id.number), goal.functor, goal.intentions);
  for (const Belief& belief : work.beliefs)
    text += line("belief", belief.name, belief.value, belief.said_by, belief.since);
  if (work.heeds != StopId{})
    text += line("heeds", whole(work.heeds.asker), whole(work.heeds.number));
  return text;
}

Work read_work(const std::string& file, std::string_view text) {
  Work work;
  int number = 0;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    ++number;
    if (line.size() == text.size())
      throw FileError(file, number, static_cast<int>(line.size()) + 1, "expected a whole line",
                      line);
    text.remove_prefix(line.size() + 1);
    try {
      read_line(parse_value(line, file), work);
    } catch (const ActivityError& error) {
      throw FileError(file, number, 1, error.what(), line);
    }
  }
  if (work.epoch == 0)
    throw FileError(file, 1, 1, "expected a line \"(at epoch cycle odom now)\"");
  return work;
}

}  // namespace saphira::intentions
