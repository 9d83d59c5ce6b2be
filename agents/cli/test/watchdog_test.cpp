#include "saphira/cli/watchdog.hpp"

#include <cmath>
#include <set>
#include <sstream>

#include "lines.hpp"

namespace saphira::cli {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A bridge (0) and two services (1, 2) of one robot, and a service of another robot (3), second by
/// second:
/// `pass N [CHILD ...]`        N s; these services wait for the robot, the others hear it
/// `beat CHILD CYCLE [waits | ends]`, `silence SECONDS`, `forget CHILD`, `slept`
/// `trouble CHILD [+SECONDS] => deaf | mute | hung | none`, so much later
class Robot {
 public:
  void take(const std::string& line) {
    std::istringstream in(line);
    std::string verb;
    std::string more;
    std::size_t number = 0;
    in >> verb >> number;
    if (verb == "pass") {
      std::set<std::size_t> waiting;
      for (std::size_t child = 0; in >> child;)
        waiting.insert(child);
      for (; number > 0; --number)
        second(waiting);
    } else if (verb == "beat") {
      std::uint64_t cycle = 0;
      in >> cycle >> more;
      beat(number, cycle,
           more == "waits"  ? std::uint64_t{Heartbeat::kWaitsForRobot}
           : more == "ends" ? std::uint64_t{Heartbeat::kEnds}
                            : 0);
    } else if (verb == "silence") {
      now_ += seconds(number);
    } else if (verb == "forget") {
      dog_.forget(number);
    } else if (verb == "slept") {
      dog_.slept(now_);
    } else {
      double later = 0.0;
      in >> more;
      if (more != "=>")
        later = std::stod(more);
      const auto at = now_ + milliseconds(std::lround(later * 1000.0));
      EXPECT_EQ(trouble(number, at), line.substr(line.find("=> ") + 3)) << line;
    }
  }

 private:
  void beat(std::size_t child, std::uint64_t cycle, std::uint64_t flags) {
    Heartbeat beat{.instance = 100 + child,
                   .cycle = cycle,
                   .flags = flags | (child == 0 ? std::uint64_t{Heartbeat::kWritesRobot} : 0)};
    dog_.hear(child, beat, now_);
  }
  void second(const std::set<std::size_t>& waiting) {
    now_ += seconds(1);
    beat(0, ++cycle_, 0);
    for (const std::size_t child : {1U, 2U})
      if (waiting.contains(child))
        beat(child, 0, Heartbeat::kWaitsForRobot);
      else
        beat(child, cycle_, 0);
  }
  std::string trouble(std::size_t child, Watchdog::Time at) const {
    const std::string text = dog_.trouble(child, at).value_or("none");
    for (const char* word : {"deaf", "mute", "hung"})
      if (text.find(word) != std::string::npos)
        return word;
    return text;
  }

  Watchdog dog_{{"a", "a", "a", "b"}};
  Watchdog::Time now_{seconds(1000)};
  std::uint64_t cycle_ = 10;
};

TEST(Watchdog, SeesWhatIsWritten) {
  EXPECT_EQ(test::play<Robot>("agents/cli/test/watchdog.txt"), 11);
}

TEST(Watchdog, NodeWithoutAProcessorDoesNotHang) {
  Watchdog dog({"a", "a", "a"});
  Watchdog::Time now{seconds(1000)};
  for (std::uint64_t i = 0; i < 10; ++i)
    for (const std::size_t child : {0, 1, 2})
      dog.hear(child, {.instance = child, .cycle = i}, now + seconds(i));
  now += seconds(9);
  for (int i = 0; i < 60; ++i) {
    now += seconds(1);
    dog.starved(1, milliseconds(900), now);
    dog.starved(2, seconds(5), now);
  }
  EXPECT_FALSE(dog.trouble(1, now)) << "6 s of its own";
  EXPECT_FALSE(dog.trouble(2, now));
  EXPECT_TRUE(dog.trouble(0, now));
  EXPECT_TRUE(dog.trouble(1, now + seconds(4)));
  EXPECT_FALSE(dog.trouble(2, now + seconds(4)));
}

}  // namespace
}  // namespace saphira::cli
