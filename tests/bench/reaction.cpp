// Reaction time: from an information packet at the bridge's socket to the command packet that
// answers it, with bridge and behaviors in processes of their own; beside it, at the same time, a
// two-hop ping over the bus with payloads of the same types. The program plays the robot server and
// the intentions.
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <future>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <thread>
#include <variant>

#include "bench.hpp"
#include "ping.hpp"
#include "saphira/base/places.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/protocol/command.hpp"
#include "saphira/protocol/information.hpp"
#include "support/guarded.hpp"
#include "support/node_options.hpp"
#include "support/quantile.hpp"

using namespace saphira;
using Clock = std::chrono::steady_clock;

namespace {

constexpr double kLimitUs = 50000.0;  // of an answer

double us_since(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

/// A robot server that sends given packets and listens.
class ScriptedRobot {
 public:
  explicit ScriptedRobot(std::string path) : path_(std::move(path)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path_.copy(address.sun_path, sizeof address.sun_path - 1);
    listen_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (bind(listen_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
        listen(listen_, 1) != 0)
      throw std::runtime_error("cannot listen on " + path_);
  }
  ~ScriptedRobot() {
    close(fd_);
    close(listen_);
    unlink(path_.c_str());
  }
  ScriptedRobot& operator=(ScriptedRobot&&) = delete;

  /// Answers the opening dialogue until the client has sent OPEN.
  void connect() {
    pollfd waiting{listen_, POLLIN, 0};
    if (poll(&waiting, 1, 10000) != 1)
      throw std::runtime_error("the bridge did not connect");
    fd_ = accept4(listen_, nullptr, nullptr, SOCK_CLOEXEC);
    int synced = -1;
    while (true) {
      const protocol::Bytes body = packet(10000);
      const std::optional<int> sync = protocol::sync_number(body);
      if (synced == 2 && sync == 1)
        return;  // OPEN has the bytes of SYNC1
      if (sync == 2)
        send(protocol::encode_sync2_reply({"Robot", "Pioneer", ""}));
      else if (sync)
        send(protocol::encode_sync(*sync));
      synced = sync.value_or(synced);
    }
  }

  void send(const protocol::Bytes& bytes) const {
    if (write(fd_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
      throw std::runtime_error("the bridge has gone");
  }

  /// The body of the next packet; empty when none comes in time.
  protocol::Bytes packet(int timeout_ms) {
    const auto end = Clock::now() + std::chrono::milliseconds(timeout_ms);
    while (true) {
      if (auto body = parser_.next())
        return *body;
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
      pollfd waiting{fd_, POLLIN, 0};
      if (left < 0 || poll(&waiting, 1, static_cast<int>(left) + 1) != 1)
        return {};
      std::uint8_t buffer[512];
      const ssize_t n = read(fd_, buffer, sizeof buffer);
      if (n <= 0)
        throw std::runtime_error("the bridge has gone");
      parser_.feed({buffer, static_cast<std::size_t>(n)});
    }
  }

 private:
  std::string path_;
  int listen_ = -1;
  int fd_ = -1;
  protocol::PacketParser parser_;
};

/// An information packet of a robot that drives at 0.2 m/s without echoes.
protocol::InformationPacket information(long n) {
  protocol::InformationPacket packet;
  packet.motors = protocol::Motors::kMoving;
  packet.left_velocity = packet.right_velocity = 79;
  packet.battery = 126;
  for (std::uint8_t i = 0; i < 3; ++i)
    packet.sonars.push_back({static_cast<std::uint8_t>((n * 3 + i) % 7), 28835});  // no echo
  return packet;
}

/// A sample as the intentions service publishes it: go far ahead and avoid obstacles. The goal is
/// to the left and to the right in turns, so that the heading changes in every cycle.
v1::Intentions intentions(const v1::Stamp& stamp) {
  const auto behavior = [](const char* schema, int priority, std::vector<v1::Argument> parameters) {
    return v1::IntendedBehavior{.name = schema,
                                .schema = schema,
                                .priority = priority,
                                .running = true,
                                .parameters = std::move(parameters)};
  };
  const double y = stamp.cycle % 2 == 0 ? 10.0 : -10.0;
  return {.stamp = stamp,
          .behavior_control = true,
          .behaviors = {behavior("AvoidCollision", 0, {}), behavior("KeepOff", 1, {}),
                        behavior("GoToPos", 2,
                                 {bus::point("goal", 50.0, y, 0.0, v1::FRAME_ODOM),
                                  bus::number("speed", 0.2), bus::number("radius", 0.2)})}};
}

class Reaction {
 public:
  Reaction(bus::Node& node, ScriptedRobot& robot)
      : robot_(robot),
        states_(std::in_place, node.reader(bus::topics::kRobotState)),
        intend_(node.writer(bus::topics::kIntentions)) {}

  /// One cycle: the time of the answer [us]; nothing without one in time.
  std::optional<double> cycle() {
    const protocol::Bytes packet = protocol::encode(information(++n_));
    const auto start = Clock::now();
    robot_.send(packet);
    std::optional<double> took;
    while (us_since(start) < kLimitUs) {
      const protocol::Bytes body = robot_.packet(10);
      if (body.empty())
        continue;
      const protocol::Command command = protocol::decode_command(body);
      const auto* heading = std::get_if<protocol::Heading>(&command);
      if (heading != nullptr && heading->heading != last_heading_) {
        took = us_since(start);
        last_heading_ = heading->heading;
        break;
      }
    }
    // For the next cycle, well after the answer.
    if (states_)
      if (const auto state = states_->take_newest())
        stamp_ = state->stamp;
    stamp_.cycle = static_cast<std::uint64_t>(n_);
    intend_.write(intentions(stamp_));
    return took;
  }

  /// The epoch is known: from now on the bridge's states go to the behaviors alone.
  void stop_reading() { states_.reset(); }

 private:
  ScriptedRobot& robot_;
  std::optional<bus::Reader<v1::RobotState>> states_;
  bus::Writer<v1::Intentions> intend_;
  v1::Stamp stamp_;
  long n_ = 0;
  double last_heading_ = -1.0;
};

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{"Reaction time of bridge and behaviors beside a two-hop ping"};
  bool json = false;
  double hz = 10.0;
  int count = 300;
  app.add_flag("--json", json, "one JSON object on the last line");
  app.add_option("--hz", hz, "information packets a second").in_range(1.0, 50.0);
  bool echo = false;
  app.add_flag("--echo", echo, "answer the ping").hidden();
  app.add_option("--count", count, "samples").in_range(10, 100000);
  if (const auto code = app.parse(argc, argv))
    return *code;
  return test::guarded([&] {
    if (echo)
      bench::echo(bus::kOpenBus);
    const std::string domain = std::to_string(bench::kDomain);
    const std::string name = "bench" + std::to_string(getpid());
    const std::string socket = "/tmp/saphira-" + name;
    ScriptedRobot robot(socket);
    const bench::Child bridge({"saphira-bridge", "--robot-port", "unix:" + socket, "--robots",
                               config_folder() + "/robots", "--robot", name, "--domain", domain});
    const bench::Child behaviors({"saphira-behaviors", "--robot", name, "--domain", domain});
    robot.connect();

    bus::Node node(test::node_options("bench", name, false, domain));
    Reaction reaction(node, robot);

    const auto period = std::chrono::duration<double>(1.0 / hz);
    const auto paced = [&](const std::function<void()>& each, int times) {
      auto next = Clock::now();
      for (int i = 0; i < times; ++i) {
        each();
        next += std::chrono::duration_cast<Clock::duration>(period);
        std::this_thread::sleep_until(next);
      }
    };
    // Until the processes have found each other and the grant is held.
    int answered = 0;
    for (int i = 0; i < 300 && answered < 20; ++i)
      paced([&] { answered = reaction.cycle() ? answered + 1 : 0; }, 1);
    if (answered < 20)
      throw std::runtime_error("no answers: bridge or behaviors do not run");
    reaction.stop_reading();

    std::vector<double> ours;
    int unanswered = 0;
    const auto take = [&] {
      if (const auto took = reaction.cycle())
        ours.push_back(*took);
      else
        ++unanswered;
    };
    // Both at once, out of phase: on the same machine at the same time. (A robot server must not
    // fall silent meanwhile.)
    const bench::Child answers({"saphira-bench-reaction", "--echo"});
    auto ping = std::async(std::launch::async, [&] {
      bench::RoundTrip trip(bus::kOpenBus);
      paced([&] { trip.measure(); }, count);
      return std::pair(trip.quantile(0.5), trip.quantile(0.99));
    });
    while (ping.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
      paced(take, 1);
    const auto [ping50, ping99] = ping.get();
    const double p50 = test::quantile(ours, 0.5);
    const double p99 = test::quantile(ours, 0.99);
    bench::print({{"ratio_p50", p50 / ping50},
                  {"ratio_p99", p99 / ping99},
                  {"p50_us", p50},
                  {"p99_us", p99},
                  {"ping_p50_us", ping50},
                  {"ping_p99_us", ping99},
                  {"unanswered", unanswered}},
                 json);
    return 0;
  });
}
