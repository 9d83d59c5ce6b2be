#include "saphira/intentions/work.hpp"

#include <charconv>
#include <cstdio>

#include "saphira/base/text.hpp"
#include "saved.hpp"

namespace saphira::intentions {
namespace {

// A whole number of 64 bits is a text: a number of the language does not hold them all.
Value whole(std::uint64_t number) {
  char text[24];
  std::snprintf(text, sizeof text, "x%llx", static_cast<unsigned long long>(number));
  return Value(text);
}

std::uint64_t read_whole(Saved& in) {
  const std::string text = in.text();
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  if (text.empty() || text.front() != 'x' ||
      std::from_chars(text.data() + 1, end, number, 16).ptr != end)
    throw ActivityError("expected a whole number in hexadecimal digits behind an x, found \"" +
                        text + "\"");
  return number;
}

void read_line(const Value& line, Work& work) {
  Saved in(line);
  const std::string kind = in.text();
  if (kind == "at") {
    work.epoch = read_whole(in);
    work.cycle = read_whole(in);
    work.odom = read_whole(in);
    work.now = in.whole<Ticks>();
  } else if (kind == "goal") {
    GoalWork& goal = work.goals.emplace_back();
    goal.id.writer = read_whole(in);
    goal.id.number = read_whole(in);
    goal.functor = in.text();
    goal.intentions = in.any();
  } else if (kind == "belief") {
    Belief& belief = work.beliefs.emplace_back();
    belief.name = in.text();
    belief.value = in.any();
    belief.said_by = in.text();
    belief.since = in.whole<Ticks>();
  } else {
    throw ActivityError("expected \"at\", \"goal\" or \"belief\"");
  }
}

}  // namespace

std::string write_work(const Work& work) {
  std::string text =
      to_text(Value(Value::List{Value("at"), whole(work.epoch), whole(work.cycle), whole(work.odom),
                                Value(static_cast<double>(work.now))})) +
      "\n";
  for (const GoalWork& goal : work.goals)
    text += to_text(Value(Value::List{Value("goal"), whole(goal.id.writer), whole(goal.id.number),
                                      Value(goal.functor), goal.intentions})) +
            "\n";
  for (const Belief& belief : work.beliefs)
    text += to_text(Value(Value::List{Value("belief"), Value(belief.name), belief.value,
                                      Value(belief.said_by),
                                      Value(static_cast<double>(belief.since))})) +
            "\n";
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
