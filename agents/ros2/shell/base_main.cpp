// saphira-ros2-base: a robot that only speaks ROS 2, as a robot server. README.md.
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>

#include "bytes.hpp"
#include "foreign_topic.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/log_line.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/stop_signals.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/ros2/base.hpp"
#include "saphira/transport/address.hpp"

namespace {

using namespace saphira;
using namespace saphira::ros2;

constexpr int kPace = 10;         // [ms]
constexpr double kEnd = 0.3;      // [s] in which a base takes the last cmd_vel
constexpr int kFixedDepth = 100;  // several programs write tf_static

struct Options {
  bus::Foreign::Options ros;
  std::string space;  // namespace
  std::string odom = "odom";
  std::string scan = "scan";
  std::vector<std::string> ranges;
  std::string battery = "battery_state";
  std::string cmd_vel = "cmd_vel";
  bool stamped = false;
  std::optional<Pose> laser;
  std::string robot_file;
};

void log(std::string_view level, const std::string& text) {
  std::fprintf(stderr, "%s\n", log_line(unix_time(), level, "ros2-base", text).c_str());
}

class Program {
 public:
  explicit Program(const Options& options)
      : options_(options),
        base_(protocol::load_parameters(options.robot_file), options.laser, BootClock::seconds()),
        foreign_(options.ros, [] {}),
        odom_(reader(options.odom, kOdom)),
        scan_(reader(options.scan, kScan)),
        battery_(reader(options.battery, kBattery)),
        cmd_vel_(options.stamped ? writer(kCmdVelStamped) : writer(kCmdVel)) {
    for (const std::string& name : options.ranges)
      ranges_.push_back(reader(name, kSonar));
    fixed_.push_back(fixed_reader("/tf_static"));
    if (!options.space.empty())
      fixed_.push_back(fixed_reader("tf_static"));
  }

  int run(int stop) {
    ::fcntl(transport::kRos2Socket, F_SETFL, O_NONBLOCK);
    bool connected = true;
    double ends = 0.0;
    while (connected || BootClock::seconds() < ends) {
      std::array<pollfd, 2> fds{{{connected ? stop : -1, POLLIN, 0},
                                 {connected ? transport::kRos2Socket : -1, POLLIN, 0}}};
      ::poll(fds.data(), fds.size(), kPace);
      const double now = BootClock::seconds();
      take(now);
      if (connected && (fds[0].revents != 0 || !take_client())) {
        connected = false;
        base_.disconnect();
        ends = now + kEnd;
      }
      write(base_.advance(now), connected);
      if (connected)
        tell(now);
    }
    return kExitOk;
  }

 private:
  std::string wire_name(const std::string& name) const {
    if (name.starts_with('/'))
      return "rt" + name;
    return "rt/" + (options_.space.empty() ? "" : options_.space + "/") + name;
  }
  template <class T>
  std::unique_ptr<bus::Foreign::Reader> reader(const std::string& name, Topic<T> topic) {
    topic.kind = Kind::wish;  // fits every writer
    return foreign_.reader(foreign(topic, wire_name(name)));
  }
  std::unique_ptr<bus::Foreign::Reader> fixed_reader(const std::string& name) {
    bus::ForeignTopic topic = foreign(kTfStatic, wire_name(name));
    topic.depth = kFixedDepth;
    return foreign_.reader(topic);
  }
  template <class T>
  std::unique_ptr<bus::Foreign::Writer> writer(Topic<T> topic) {
    topic.kind = Kind::usual;
    return foreign_.writer(foreign(topic, wire_name(options_.cmd_vel)));
  }

  template <class T, class Each>
  static void each(bus::Foreign::Reader& reader, const Each& take) {
    for (bus::ForeignSample& sample : reader.take())
      if (const auto message = read<T>(std::move(sample.bytes)))
        take(*message);
  }

  void take(double now) {
    for (const auto& reader : fixed_)
      each<TFMessage>(*reader, [&](const auto& message) { base_.take(message); });
    each<BatteryState>(*battery_, [&](const auto& message) { base_.take(message); });
    each<Odometry>(*odom_, [&](const auto& message) { base_.take(message, now); });
    each<LaserScan>(*scan_, [&](const auto& message) { base_.take(message, now); });
    for (const auto& reader : ranges_)
      for (const bus::ForeignSample& sample : reader->take()) {
        auto message = read<Range>(sample.bytes);
        if (!message)  // Humble's has no variance
          message = read<Range>(sample.bytes + std::string(sizeof(float), '\0'));
        if (message)
          base_.take(*message, now);
      }
    base_.heard(cmd_vel_->matched() > 0);
  }

  /// False: the client has gone.
  bool take_client() {
    std::array<std::uint8_t, 4096> buffer{};
    const ssize_t size = ::read(transport::kRos2Socket, buffer.data(), buffer.size());
    if (size > 0)
      base_.receive({buffer.data(), static_cast<std::size_t>(size)});
    return size > 0 || (size < 0 && (errno == EAGAIN || errno == EINTR));
  }

  static void send(const void* bytes, std::size_t size) {
    // A client that does not read loses packets.
    [[maybe_unused]] const ssize_t sent = ::send(transport::kRos2Socket, bytes, size, MSG_NOSIGNAL);
  }

  void write(const Base::Output& output, bool connected) {
    if (connected && !output.to_client.empty())
      send(output.to_client.data(), output.to_client.size());
    if (!output.cmd_vel)
      return;
    if (!options_.stamped) {
      cmd_vel_->write(bytes_of(*output.cmd_vel));
      return;
    }
    const double now = unix_time();
    const auto seconds = static_cast<std::int32_t>(now);
    TwistStamped message{
        .header = {{seconds, static_cast<std::uint32_t>((now - seconds) * 1e9)}, base_.frame()},
        .twist = *output.cmd_vel};
    cmd_vel_->write(bytes_of(message));
  }

  /// Tells why there is no robot yet, a line each, and with an empty line that there is one. From
  /// then on the socket carries packets.
  void tell(double now) {
    std::string trouble = base_.trouble(now);
    if (trouble == told_)
      return;
    told_ = trouble;
    log(trouble.empty() ? "info" : "warning", trouble.empty() ? "the robot is there" : trouble);
    if (ready_)
      return;
    ready_ = trouble.empty();
    if (!ready_)
      trouble += " (/" + options_.space + ", domain " + std::to_string(options_.ros.domain) + ")";
    trouble += '\n';
    send(trouble.data(), trouble.size());
  }

  const Options options_;
  Base base_;
  bus::Foreign foreign_;
  std::unique_ptr<bus::Foreign::Reader> odom_, scan_, battery_;
  std::vector<std::unique_ptr<bus::Foreign::Reader>> ranges_, fixed_;
  std::unique_ptr<bus::Foreign::Writer> cmd_vel_;
  std::string told_ = "none yet";
  bool ready_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{
      "A robot that only speaks ROS 2, as a robot server; saphira-bridge starts it for the link "
      "ros2:NAMESPACE,OPTION=VALUE..."};
  Options options;
  options.ros.name = "saphira_base";
  unsigned domain = 0;
  std::string cmd_vel = "twist";
  std::vector<double> laser;
  std::string robots;
  app.add_option("--namespace", options.space, "namespace of the robot's topics");
  app.add_option("--domain", domain, "domain of ROS 2")
      .environment("ROS_DOMAIN_ID")
      .in_range(0, 231);
  app.add_option("--interface", options.ros.interface, "address of the one interface for ROS 2")
      .ipv4();
  app.add_option("--odom", options.odom, "topic of the odometry");
  app.add_option("--scan", options.scan, "topic of the laser's scans");
  app.add_option("--range", options.ranges, "topic of ranges; again for each (usual: sonar)")
      .one_value_each();
  app.add_option("--battery", options.battery, "topic of the battery");
  app.add_option("--drive", options.cmd_vel, "topic of the velocity");
  app.add_option("--cmd-vel", cmd_vel, "its type").one_of({"twist", "stamped"});
  app.add_option("--laser", laser,
                 "place of the laser on the robot, X:Y:TH in m, m, degrees (usual: as tf_static "
                 "says)")
      .separated_by(':')
      .values(3);
  app.add_option("--robots", robots, "folder of robot parameter files");
  app.add_option("--robot-file", options.robot_file, "the robot's parameter file").shows("ros2");
  if (const auto code = app.parse(argc, argv))
    return *code;
  return exit_code_of("saphira-ros2-base", [&] {
    options.ros.domain = domain;
    options.stamped = cmd_vel == "stamped";
    if (options.ranges.empty())
      options.ranges = {"sonar"};
    if (!laser.empty())
      options.laser = Pose{laser[0], laser[1], radians(laser[2])};
    if (robots.empty())
      robots = config_folder() + "/robots";
    options.robot_file =
        find_file(robots, options.robot_file.empty() ? "ros2" : options.robot_file, ".p");
    const int stop = stop_on_signals();
    return Program(options).run(stop);
  });
}
