// The inputs of a relay, one per line: its file of robots, addresses and paths; and visitors who
// come (+), are fetched (/carry) and leave (-) in any order. Each text is parsed or gives an error
// in words; no visitor is fetched twice or by another robot; a robot's visitors are bounded.

#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "fuzz.hpp"
#include "saphira/relay/rendezvous.hpp"

using namespace saphira::relay;

namespace {

/// Passes a line to every reader of text.
void read(const std::string& line) {
  try {
    for (const Robot& robot : parse_robots("robots", line))
      saphira::fuzz::require(!robot.name.empty() && robot.port > 0 && robot.port < 65536);
  } catch (const std::invalid_argument& error) {
    saphira::fuzz::require(std::string_view(error.what()).starts_with("robots"));
  }
  try {
    const Address address = parse_address(line);
    saphira::fuzz::require(!address.host.empty() && !address.robot.empty() && address.port > 0);
  } catch (const std::invalid_argument& error) {
    saphira::fuzz::require(*error.what() != 0);
  }
}

}  // namespace

void saphira::fuzz::run(std::string_view text) {
  Rendezvous relay({{"pioneer", 1, "0123456789abcdef"}, {"flakey", 2, "fedcba9876543210"}});
  std::map<std::string, std::set<Rendezvous::Visitor>> there;  // by robot
  std::map<Rendezvous::Visitor, std::string> waiting;          // robot
  Rendezvous::Visitor last = 0;
  double now = 0.0;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line(text.substr(at, end - at));
    at = end + 1;
    now += 0.5;
    read(line);
    for (const Rendezvous::Visitor gone : relay.expire(now)) {
      require(waiting.contains(gone));
      there[waiting[gone]].erase(gone);
      waiting.erase(gone);
    }
    if (line.starts_with("+")) {
      const std::string robot = line.find("flakey") == std::string::npos ? "pioneer" : "flakey";
      ++last;
      if (const auto gone = relay.arrive(robot, line, last, std::to_string(last), now)) {
        require(there[robot].erase(*gone) == 1);
        waiting.erase(*gone);
      }
      there[robot].insert(last);
      waiting[last] = robot;
      require(there[robot].size() <= Rendezvous::kMost);
    } else if (const auto path = parse_path(line)) {
      if (const auto visitor = relay.fetch(path->robot, path->ticket)) {
        require(waiting.contains(*visitor) && waiting[*visitor] == path->robot);
        waiting.erase(*visitor);
      }
    } else if (line.starts_with("-") && last > 0) {
      const Rendezvous::Visitor visitor = 1 + line.size() % last;
      relay.leave(visitor);
      waiting.erase(visitor);
      there["pioneer"].erase(visitor);
      there["flakey"].erase(visitor);
    }
  }
}
