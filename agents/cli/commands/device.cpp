// The command `saphira device`: the state of the robot's devices, and requests to them.
#include <algorithm>
#include <cstdio>
#include <set>

#include "commands.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/base/cycle.hpp"
#include "saphira/base/format.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/cli/device_words.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr double kDevicePatience = 10.0;  ///< [s]; the bridge gives a request up after 5
constexpr double kAnswerTime = 1.0;       ///< [s] for a device on a serial port

/// The robot's devices as they are on the bus.
class Watch {
 public:
  explicit Watch(const bus::NodeOptions& options) : node(options), processes(node) {}

  void poll() {
    processes.poll();
    robot.poll();
    devices.poll();
  }

  bus::Node node;
  Processes processes;
  Newest<v1::RobotState> robot{node, bus::topics::kRobotState};
  Newest<v1::Devices> devices{node, bus::topics::kDevices};
};

int nobody(const Watch& watch) {
  return failed("no robot: " + who_is_there(watch.processes));
}

/// Until a robot that is not heard counts as absent.
milliseconds patience(const Watch& watch) {
  return std::max(milliseconds(3000), listening_time(watch.node, watch.processes.heard_any()));
}

int list_devices(const bus::NodeOptions& options, const bus::Stop& stop) {
  Watch watch(options);
  // The devices are latched: they come with the discovery, as the state does.
  wait_for(watch.node, patience(watch), stop, [&] {
    watch.poll();
    return watch.robot && watch.devices;
  });
  if (!watch.robot)
    return nobody(watch);
  std::fputs(table(device_rows(*watch.robot, watch.devices.get())).c_str(), stdout);
  return bus::kExitOk;
}

/// Prints each line of the list, whenever it changes.
int follow(const bus::NodeOptions& options, const bus::Stop& stop) {
  Watch watch(options);
  std::set<std::vector<std::string>> shown;
  auto said = Clock::now();
  while (!stop.requested()) {
    watch.node.wait(milliseconds(500), &stop);
    watch.poll();
    if (!watch.robot) {
      if (Clock::now() - said > patience(watch)) {
        nobody(watch);
        said = Clock::now();
      }
      continue;
    }
    const auto rows = device_rows(*watch.robot, watch.devices.get());
    const std::set<std::vector<std::string>> now(rows.begin() + 1, rows.end());
    for (const auto& row : rows)
      if (now.contains(row) && !shown.contains(row))
        std::printf("%8.1f s  %-14s  %s\n", seconds_of(watch.robot->stamp.cycle), row[0].c_str(),
                    row[1].c_str());
    std::fflush(stdout);
    if (std::ferror(stdout) != 0)
      return bus::kExitOk;  // the reader of our output has left
    shown = now;
  }
  return bus::kExitOk;
}

void print_serial(const v1::SerialData& data) {
  std::string hex;
  std::string text;
  for (const std::uint8_t byte : data.data) {
    hex += format("%02x ", byte);
    text += byte >= 0x20 && byte < 0x7F ? static_cast<char>(byte) : '.';
  }
  std::printf("port %d  %s |%s|\n", data.port, hex.c_str(), text.c_str());
}

/// Prints the answers from a serial port for kAnswerTime: a device there needs a moment.
void wait_for_serial(Watch& watch, bus::Reader<v1::SerialData>& serial, const Request& asked,
                     const bus::Stop& stop) {
  const auto sent = Clock::now();
  while (!stop.requested() && seconds_since(sent) < kAnswerTime) {
    watch.node.wait(milliseconds(50), &stop);
    for (const auto& sample : serial.take())
      if (sample.data.port == number_of(asked.arguments, "port"))
        print_serial(sample.data);
  }
}

int ask(const DeviceCommand& command, const bus::NodeOptions& options, const bus::Stop& stop) {
  Watch watch(options);
  auto serial = watch.node.reader(bus::topics::kSerialData);
  bus::RequestClient bridge(watch.node, *command.topic, "saphira device");
  const v1::Answer answer =
      bridge.ask(to_bus(command.request), kDevicePatience, &stop, [&] { watch.poll(); });
  if (answer.code == v1::ANSWER_NOBODY && answer.service.empty())
    return nobody(watch);
  if (answer.code == v1::ANSWER_TOO_LATE && answer.service.empty())
    return failed(answer.text + "; " + who_is_there(watch.processes));
  std::printf("%s\n", answer.text.c_str());
  if (!bus::well(answer.code))
    return bus::kExitFailed;
  if (number_of(command.request.arguments, "answer") > 0)
    wait_for_serial(watch, serial, command.request, stop);
  return bus::kExitOk;
}

int device(const std::vector<std::string>& words, const bus::NodeOptions& options,
           const bus::Stop& stop) {
  if (words.empty() || words == std::vector<std::string>{"list"})
    return list_devices(options, stop);
  if (words == std::vector<std::string>{"follow"})
    return follow(options, stop);
  return ask(parse_device(words), options, stop);
}

}  // namespace

void add_device(CLI::App& app, Chosen& chosen) {
  auto words = std::make_shared<std::vector<std::string>>();
  auto answer = std::make_shared<int>(0);
  CLI::App* command =
      app.add_subcommand("device", "Devices that the robot carries: list, follow and use them");
  command->add_option("words", *words, "list | follow | DEVICE what-it-is-to-do, as below");
  command->add_option("--answer", *answer, "serial: so many bytes are asked for afterwards");
  command->footer(std::string(kDeviceWords) +
                  "Exit code 0: the robot shows it, or no packet would; 1: it does not.");
  chosen.when(command, [words, answer](const bus::NodeOptions& node, const bus::Stop& stop) {
    std::vector<std::string> all = *words;
    if (*answer > 0) {
      all.emplace_back("--answer");
      all.push_back(std::to_string(*answer));
    }
    return device(all, node, stop);
  });
}

}  // namespace saphira::cli
