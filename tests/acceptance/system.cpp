#include "system.hpp"

#include <cmath>
#include <fstream>
#include <sstream>

namespace saphira::test {

namespace {

bus::NodeOptions node_options(const std::string& robot) {
  bus::NodeOptions options;
  options.name = "test";
  options.robot = robot;
  options.domain = static_cast<std::uint32_t>(std::stoul(domain()));
  return options;
}

}  // namespace

bool Truth::still() const {
  return std::abs(velocity) < 0.005 && std::abs(rotation_velocity) < 0.01;
}

System::System(std::string bridge_port)
    : bridge_port_(std::move(bridge_port)), node_(node_options(robot_)), goals_(node_, "test") {
  if (bridge_port_.empty())
    bridge_port_ = "unix:" + simulator_socket();
}

void System::start(const std::string& name) {
  std::vector<std::string> argv{name};
  if (name == "saphira-sim") {
    for (const std::string& word :
         {std::string("--world"), source("config/worlds/office.wld"), std::string("--robot"),
          source("config/robots/pioneer.p"), std::string("--socket"), simulator_socket(),
          std::string("--trace"), folder_.path("trace.csv"), std::string("--seed"),
          std::string("1")})
      argv.push_back(word);
  } else {
    for (const std::string& word :
         {std::string("--robot"), robot_, std::string("--domain"), domain()})
      argv.push_back(word);
  }
  if (name == "saphira-bridge")
    for (const std::string& word :
         {std::string("--robot-port"), bridge_port_, std::string("--robots"),
          source("config/robots"), std::string("--state"), folder_.path("bridge.state")})
      argv.push_back(word);
  if (name == "saphira-intentions") {
    argv.emplace_back("--memory");
    argv.push_back(folder_.path("goals"));
  }
  if (name == "saphira-registration")
    for (const std::string& word : {std::string("--map"), source("config/maps/office.map"),
                                    std::string("--map-memory"), folder_.path("map.memory")})
      argv.push_back(word);
  processes_.erase(name);
  processes_[name] = std::make_unique<Process>(argv, folder_.path(name + ".log"));
}

void System::start_all() {
  for (const char* name : {"saphira-sim", "saphira-bridge", "saphira-behaviors",
                           "saphira-intentions", "saphira-interpretation", "saphira-registration"})
    start(name);
}

v1::GoalId System::go_to(double x, double y) {
  v1::Goal goal;
  goal.functor("go_to");
  goal.arguments({bus::point("position", x, y, 0.0, v1::FRAME_ODOM)});
  return goals_.ask(goal);
}

Truth System::truth() const {
  std::ifstream in(folder_.path("trace.csv"));
  std::string line;
  std::string newest;
  while (std::getline(in, line))
    if (!in.eof() && !line.empty() && line[0] != 'c')
      newest = line;
  Truth truth;
  std::vector<double> values;
  std::istringstream words(newest);
  for (std::string word; std::getline(words, word, ',');)
    values.push_back(std::strtod(word.c_str(), nullptr));
  if (values.size() >= 11) {
    truth.cycle = static_cast<long>(values[0]);
    truth.x = values[1];
    truth.y = values[2];
    truth.velocity = values[4];
    truth.rotation_velocity = values[5];
    truth.contacts = static_cast<long>(values[10]);
  }
  return truth;
}

bool System::wait_moving(std::chrono::milliseconds limit) {
  return wait_until([this] { return truth().velocity > 0.15; }, limit);
}

bool System::wait_still(std::chrono::milliseconds limit) {
  return wait_until([this] { return truth().still(); }, limit);
}

std::string System::output() const {
  std::string all;
  for (const auto& [name, process] : processes_)
    all += "--- " + name + "\n" + process->output();
  return all;
}

}  // namespace saphira::test
