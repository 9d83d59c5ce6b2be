// The speed of the simulator: robots that wander about the office floor with their sonars on, each
// by the packets of a client, on one core. As an upper bound also the sonars alone, without the
// cost of dynamics, contacts and packets.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/random.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/protocol/command.hpp"
#include "saphira/protocol/information.hpp"
#include "saphira/sim/simulation.hpp"

namespace {

using namespace saphira;

// CPU time of this thread, without other work on the machine.
double seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

constexpr double kCell = 0.1;  // [m]

/// Places that a robot can reach from the world's start, unordered.
std::vector<Vec2> reachable(const sim::World& world, double radius) {
  const auto columns = static_cast<int>(world.width / kCell);
  const auto rows = static_cast<int>(world.height / kCell);
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(x);
  };
  std::vector<bool> seen(index(0, rows));
  std::deque<std::pair<int, int>> open{
      {static_cast<int>(world.start->x / kCell), static_cast<int>(world.start->y / kCell)}};
  std::vector<Vec2> found;
  sim::Neighbourhood near(world, radius + 0.1);
  while (!open.empty()) {
    const auto [x, y] = open.front();
    open.pop_front();
    if (x < 0 || y < 0 || x >= columns || y >= rows || seen[index(x, y)])
      continue;
    seen[index(x, y)] = true;
    const Vec2 at((x + 0.5) * kCell, (y + 0.5) * kCell);
    if (sim::distance(near.around(at), at) < radius + 0.05)
      continue;
    found.push_back(at);
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
      open.emplace_back(x + dx, y + dy);
  }
  return found;
}

/// A wandering client: straight on while the front is free, else aside.
class Wanderer {
 public:
  explicit Wanderer(std::uint64_t seed) : random_(seed, 77), ranges_(64, 5.0) {}

  protocol::Bytes act(const protocol::Bytes& from_robot) {
    parser_.feed(from_robot);
    double left = 5.0;
    double right = 5.0;
    while (const auto body = parser_.next())
      if (const auto packet = protocol::decode_information(*body))
        for (const protocol::RawSonar& sonar : packet->sonars)
          ranges_[sonar.number % ranges_.size()] = sonar.range * 0.1734e-3;
    for (std::size_t i = 0; i < 4; ++i) {
      left = std::min(left, ranges_[i]);
      right = std::min(right, ranges_[6 - i]);
    }
    if (random_.chance(0.02))
      drift_ = random_.uniform(-0.4, 0.4);
    const double near = std::min(left, right);
    const double turn = near > 0.8 ? drift_ : left < right ? -1.0 : 1.0;
    protocol::Bytes out = encode(protocol::Velocity{std::clamp(near - 0.35, 0.0, 0.4)});
    const protocol::Bytes more = encode(protocol::RotationVelocity{turn});
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }

 private:
  Random random_;
  protocol::PacketParser parser_;
  std::vector<double> ranges_;
  double drift_ = 0.0;
};

struct Result {
  double robot_seconds = 0.0;  ///< simulated time per second
  double bound = 0.0;          ///< with the sonars alone
  int contacts = 0;
  double way = 0.0;  ///< [m]
};

Result run(const sim::World& world, const protocol::RobotParameters& parameters,
           const std::vector<Vec2>& places, std::size_t robots, int cycles) {
  Random random(robots);
  sim::Simulation simulation(world);
  std::vector<Wanderer> clients;
  while (simulation.size() < robots) {
    const Vec2& at = places[random.next() % places.size()];
    if (simulation.scene().distance(at) < parameters.radius + 0.05)
      continue;
    sim::ServerOptions options;
    options.seed = simulation.size() + 1;
    const auto number =
        simulation.add(parameters, {at.x(), at.y(), random.uniform(-kPi, kPi)}, options);
    clients.emplace_back(options.seed);
    for (int i = 0; i < 3; ++i)
      simulation.receive(number, protocol::encode_sync(i));
    simulation.receive(number, encode(protocol::Open{}));
    simulation.receive(number, encode(protocol::Enable{true}));
  }

  Result result;
  std::vector<Pose> poses;  // the poses, cycle by cycle
  poses.reserve(robots * static_cast<std::size_t>(cycles));
  const double begin = seconds();
  for (int cycle = 0; cycle < cycles; ++cycle) {
    for (sim::RobotNumber i = 0; i < robots; ++i)
      simulation.receive(i, clients[i].act(simulation.server(i).take_output()));
    simulation.advance(sim::kTicksPerPacket);
    for (sim::RobotNumber i = 0; i < robots; ++i)
      poses.push_back(simulation.scene().robot(i).pose_in_world());
  }
  const double simulated = 0.1 * cycles * static_cast<double>(robots);
  result.robot_seconds = simulated / (seconds() - begin);
  for (sim::RobotNumber i = 0; i < robots; ++i) {
    result.contacts += simulation.scene().robot(i).contacts();
    result.way += std::abs(simulation.scene().robot(i).left_way());
  }

  std::vector<sim::Sonars> sonars;
  for (sim::RobotNumber i = 0; i < robots; ++i)
    sonars.emplace_back(simulation.scene(), sim::kNobody, parameters, sim::SonarModel{}, i);
  const double begin_of_sonars = seconds();
  double sum = 0.0;
  std::size_t at = 0;
  int fired = 0;
  for (int cycle = 0; cycle < cycles; ++cycle)
    for (sim::RobotNumber i = 0; i < robots; ++i, ++at)
      // 25 a second: five in two cycles.
      for (int k = 0; k < 2 + cycle % 2; ++k)
        sum +=
            sonars[i].fire(static_cast<std::uint8_t>(fired++ % 7), poses[at]).range.value_or(0.0);
  result.bound = simulated / (seconds() - begin_of_sonars);
  if (std::isnan(sum))
    std::puts("a sonar said what it must not");
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{"Speed of the simulator on one core, in robot-seconds a second"};
  bool json = false;
  double length = 5000.0;
  std::string world_file = "worlds/office-floor.wld";
  std::string robot_file = "robots/pioneer.p";
  app.add_flag("--json", json, "one JSON object on the last line");
  app.add_option("--length", length, "robot-seconds to simulate of each kind").in_range(10.0, 1e7);
  app.add_option("--world", world_file, "below config/");
  app.add_option("--robot", robot_file, "below config/; with seven sonars");
  if (const auto code = app.parse(argc, argv))
    return *code;

  try {
    const sim::World world = sim::load_world(config_folder() + "/" + world_file);
    const auto parameters = protocol::load_parameters(config_folder() + "/" + robot_file);
    const std::vector<Vec2> places = reachable(world, parameters.radius);
    nlohmann::json object;
    for (const std::size_t robots : {1U, 10U, 100U}) {
      const auto cycles = static_cast<int>(length * 10.0 / static_cast<double>(robots));
      std::vector<Result> results;
      results.reserve(3);
      for (int i = 0; i < 3; ++i)
        results.push_back(run(world, parameters, places, robots, cycles));
      std::sort(results.begin(), results.end(),
                [](const Result& a, const Result& b) { return a.robot_seconds < b.robot_seconds; });
      const Result& median = results[1];
      std::printf(
          "%3zu robots: %6.0f robot-seconds a second (%.0f x real time); bound, sonars alone: "
          "%.0f; %.1f m and %.2f contacts a robot and minute\n",
          robots, median.robot_seconds, median.robot_seconds / static_cast<double>(robots),
          median.bound, median.way / length * 60.0, median.contacts / length * 60.0);
      const std::string number = std::to_string(robots);
      object["robot_seconds_per_second_" + number] = median.robot_seconds;
      object["bound_" + number] = median.bound;
    }
    if (json)
      std::printf("%s\n", object.dump().c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "saphira bench sim: %s\n", error.what());
    return 2;
  }
}
