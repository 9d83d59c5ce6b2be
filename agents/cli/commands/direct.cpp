// move, turn and speed: direct motion control (manual 6.4) from the command line.
#include "direct.hpp"

#include <algorithm>
#include <stdexcept>

#include "commands.hpp"
#include "saphira/base/guess.hpp"
#include "saphira/bus/introspect.hpp"
#include "saphira/cli/done.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/geometry/pose.hpp"

namespace saphira::cli {

namespace {

constexpr double kStuck = 5.0;  ///< [s] without any progress

}  // namespace

std::vector<std::string> topic_names() {
  std::vector<std::string> names;
  for (const bus::TopicEntry& entry : bus::known_topics())
    names.push_back(entry.name);
  return names;
}

void expect_topic(const std::string& topic) {
  const std::vector<std::string> names = topic_names();
  if (std::ranges::find(names, topic) == names.end())
    throw std::invalid_argument("no topic \"" + topic.substr(0, 200) + '"' +
                                did_you_mean(topic, names, ": expected one such as robot/state;") +
                                " saphira wiring shows all, saphira list those of what runs");
}

std::string qos_of(const std::string& topic) {
  for (const bus::TopicEntry& entry : bus::known_topics())
    if (entry.name == topic)
      return entry.qos;
  return {};
}

namespace {

/// Repeats the command until it is done, as shown by the bridge.
int move(const Move& wanted, double seconds, const bus::NodeOptions& options,
         const bus::Stop& stop) {
  bus::Node node(options);
  DirectDriver driver(node, bus::topics::kDriveDirect, "saphira " + wanted.name);
  const auto began = Clock::now();
  auto moved = began;
  double nearest = 1e9;
  Course course(wanted);
  int code = bus::kExitFailed;
  std::string end = "stopped by Ctrl-C";
  while (!stop.requested()) {
    if (seconds > 0.0 && seconds_since(began) >= seconds) {
      code = bus::kExitOk;
      end = "the time is over";
      break;
    }
    if (driver.robot())
      driver.drive(command_of(wanted));
    if (const auto news = driver.news())
      complain("saphira: %s\n", news->c_str());
    node.wait(kDrivePeriod, &stop);
    driver.poll();
    if (!driver.stopped_by().empty()) {
      end = "stopped by " + driver.stopped_by();
      break;
    }
    if (driver.grant() && driver.robot()) {
      const Course::State state = course.update(driver.drives(), *driver.grant(), *driver.robot());
      if (state == Course::State::done) {
        code = bus::kExitOk;
        end = "done";
        break;
      }
      if (state == Course::State::interrupted) {
        end = "interrupted: " +
              (driver.drives()
                   ? "the robot was not heard for a while, or its bridge was started again"
                   : describe(*driver.grant()));
        break;
      }
      if (state == Course::State::drives && course.left() < nearest - kProgress) {
        nearest = course.left();
        moved = Clock::now();
      }
    }
    if (wanted.kind != Move::Kind::speed && seconds_since(moved) > kStuck) {
      end = driver.drives() ? "given up: it has come no nearer for 5 s"
                            : "given up: it was not allowed to drive for 5 s";
      break;
    }
  }
  driver.release();
  print("%s%s\n", end.c_str(), code == bus::kExitOk ? "" : course.rest().c_str());
  return code;
}

struct DirectOptions {
  double value = 0.0;
  double speed = 0.0;
  double seconds = 0.0;
};

CLI::App* add(CLI::App& app, Chosen& chosen, Move::Kind kind, const char* name, const char* help,
              const char* value, const char* unit, const std::shared_ptr<DirectOptions>& options) {
  CLI::App* command = app.add_subcommand(name, help);
  command->add_option("value", options->value, value)
      ->required()
      ->check(CLI::Number)
      ->transform(number_in_unit(unit));
  command->footer(
      "The robot stops when this ends. The guard beside it holds; a person's keyboard is "
      "stronger,\n"
      "goals are weaker. Numbers may have a unit: 30cm, 1.5rad, 0.2m/s. Exit code 0: done.");
  chosen.when(command, [=](const bus::NodeOptions& node, const bus::Stop& stop) -> int {
    const double wish = kind == Move::Kind::turn ? radians(options->value) : options->value;
    const Move wanted{kind, name, wish, options->speed};
    if (const std::string wrong = trouble_of(wanted); !wrong.empty())
      throw std::invalid_argument(wrong);
    return move(wanted, options->seconds, node, stop);
  });
  return command;
}

}  // namespace

void add_direct(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<DirectOptions>();
  add(app, chosen, Move::Kind::move, "move", "Drive so far straight on, and say when it is done",
      "METERS, below 0: back", "m", options)
      ->add_option("--speed", options->speed, "[m/s] at most")
      ->check(above_zero())
      ->transform(number_in_unit("m/s"));
  options = std::make_shared<DirectOptions>();
  add(app, chosen, Move::Kind::turn, "turn",
      "Turn on the spot by an angle, and say when it is done",
      "DEGREES to the left, below 0: to the right", "deg", options);
  options = std::make_shared<DirectOptions>();
  add(app, chosen, Move::Kind::speed, "speed", "Drive at a speed, until Ctrl-C", "METERS a second",
      "m/s", options)
      ->add_option("--for", options->seconds, "[s] so long")
      ->check(above_zero())
      ->transform(number_in_unit("s"));
}

}  // namespace saphira::cli
