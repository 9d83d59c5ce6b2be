#include "watch.hpp"

#include <unistd.h>

#include <array>
#include <ctime>
#include <iostream>
#include <string_view>

#include "saphira/base/format.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/cli/printer.hpp"

namespace saphira::cli {

void DeploymentWatch::poll() {
  processes_.poll();
  const double now = seconds_since(Clock::time_point{});
  if (const auto news = second_.news(processes_.all(), now))
    complain("saphira: %s\n", news->c_str());
}

void DeploymentWatch::settle(const bus::Stop& stop) {
  while (second_.doubtful() && !stop.requested()) {
    node_.wait(std::chrono::milliseconds(100), &stop);
    poll();
  }
}

std::string person(const std::string& program, bool since) {
  const char* const user = getlogin();
  std::string text = user == nullptr ? program : program + " of " + user;
  std::array<char, 256> host{};
  if (gethostname(host.data(), host.size() - 1) == 0)
    text += " at " + std::string(host.data());
  std::string where;
  if (const char* const terminal = ttyname(STDIN_FILENO); terminal != nullptr)
    where = std::string_view(terminal).starts_with("/dev/") ? terminal + 5 : terminal;
  if (since) {
    where += (where.empty() ? "" : ", ") + local_text(std::time(nullptr), "since %H:%M");
  }
  return where.empty() ? text : text + " (" + where + ")";
}

int nothing_there(const std::string& what, const Processes& processes, const std::string& why) {
  const bool alone = processes.all().empty();
  (alone ? std::cerr << "saphira: " : std::cout) << "no " << what << "; " << why << '\n';
  return alone ? bus::kExitFailed : bus::kExitOk;
}

std::string called(const std::string& robot) {
  return robot == kEveryRobot ? "every robot" : "robot " + robot;
}

std::set<std::string> robots_heard(const bus::NodeOptions& options, const bus::Stop& stop,
                                   const std::function<bool(const bus::EndpointEntry&)>& tells) {
  bus::Node node(options);
  const bus::Census census(node);
  poll_for(node, listening_time(node), stop, [] {});
  std::set<std::string> robots;
  for (const bus::EndpointEntry& entry : census.endpoints())
    if (tells(entry))
      robots.insert(entry.robot);
  return robots;
}

v1::Answer ask_program(const std::string& program, bus::Node& node, bus::RequestClient& client,
                       const v1::Request& request, double patience, const bus::Stop& stop,
                       Processes& processes, bus::RequestClient::Hear hear) {
  struct Absent {
    std::string words;
  };
  try {
    return client.ask(
        request, patience, &stop,
        [&] {
          processes.poll();
          if (std::string words = absence(node, processes, program); !words.empty())
            throw Absent{std::move(words)};
        },
        std::move(hear));
  } catch (const Absent& absent) {
    return v1::Answer{.code = v1::ANSWER_NOBODY, .text = absent.words};
  }
}

}  // namespace saphira::cli
