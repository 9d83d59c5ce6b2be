// write: any topic by its name, from a shell or a script.
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "commands.hpp"
#include "direct.hpp"
#include "input_lines.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/introspect.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/cli/gathering.hpp"
#include "saphira/cli/printer.hpp"
#include "system/system.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr double kNobodyReads = 3.0;  ///< [s]
constexpr double kAnswer = 20.0;      ///< [s] for an answer to a request
constexpr int kDelivered = 2000;      ///< [ms]

struct WriteOptions {
  std::string topic;
  std::string json;
  double seconds = 0.0;
  bool force = false;
};

/// The samples in their order: the one of the command line, or each line of standard input.
class Samples {
 public:
  explicit Samples(const std::string& json) : input_(json == "-") {
    if (!input_)
      given_ = json;
  }
  /// Nothing: none has come yet, or there is no other.
  std::optional<std::string> next() {
    return input_ ? lines_.next() : std::exchange(given_, std::nullopt);
  }
  bool ended() const { return input_ ? lines_.ended() : !given_; }
  bool from_input() const { return input_; }

 private:
  bool input_;
  std::optional<std::string> given_;
  InputLines lines_;
};

nlohmann::json object_of(const std::string& text) {
  nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  // The conversion to a sample refuses text that is not a JSON object.
  return json.is_object() ? json : nlohmann::json();
}

/// A motor command; missing members get their natural values.
v1::MotorCommand motor_command(const std::string& text) {
  v1::MotorCommand command{.active = true};
  bus::from_json(text, command);
  const nlohmann::json json = object_of(text);
  if (json.contains("velocity") && !json.contains("translation"))
    command.translation = v1::TRANSLATION_VELOCITY;
  if (json.contains("rotation_velocity") && !json.contains("rotation"))
    command.rotation = v1::ROTATION_VELOCITY;
  return command;
}

/// Drives for the command's life: a motor command is valid for a fraction of a second.
int drive(const WriteOptions& options, const bus::Topic<v1::MotorCommand>& topic,
          const bus::NodeOptions& node_options, const bus::Stop& stop) {
  Samples samples(options.json);
  // An error on the command line moves nothing.
  std::optional<v1::MotorCommand> command;
  if (!samples.from_input())
    command = motor_command(*samples.next());
  bus::Node node(node_options);
  DirectDriver driver(node, topic, "saphira write");
  const auto began = Clock::now();
  while (!stop.requested() && (options.seconds <= 0.0 || seconds_since(began) < options.seconds)) {
    while (const auto line = samples.next())
      command = motor_command(*line);
    if (samples.from_input() && samples.ended())
      break;
    if (command)
      driver.drive(*command);
    if (const auto news = driver.news())
      complain("saphira: %s\n", news->c_str());
    node.wait(kDrivePeriod, &stop);
    driver.poll();
    if (!driver.stopped_by().empty()) {
      driver.release();
      complain("saphira: stopped by %s\n", driver.stopped_by().c_str());
      return bus::kExitFailed;
    }
  }
  driver.release();
  return bus::kExitOk;
}

int ask(const WriteOptions& options, const bus::RequestTopic& topic,
        const bus::NodeOptions& node_options, const bus::Stop& stop) {
  Samples samples(options.json);
  bus::Node node(node_options);
  bus::RequestClient client(node, topic, person("saphira write"));
  int code = bus::kExitOk;
  while (!stop.requested() && !samples.ended()) {
    const auto line = samples.next();
    if (!line) {
      node.wait(milliseconds(50), &stop);
      continue;
    }
    v1::Request request;
    bus::from_json(*line, request);
    const v1::Answer answer = client.ask(request, kAnswer, &stop);
    print("%s%s%s\n", bus::well(answer.code) ? "done" : "not done", answer.text.empty() ? "" : ": ",
          answer.text.c_str());
    if (!bus::well(answer.code))
      code = bus::kExitFailed;
  }
  return code;
}

/// Adds members that have to be unique, and that a person would not write.
std::string completed(const std::string& topic, const std::string& text, const bus::Node& node) {
  nlohmann::json json = object_of(text);
  const bool goal = topic == bus::topics::kGoals.name;
  const bool other =
      topic == bus::topics::kTriggers.name || topic == bus::topics::kBeliefClaims.name;
  if (!json.is_object() || (!goal && !other))
    return text;
  // Each line of the input changes the same goal, and sets another trigger or belief.
  if (!json.contains("id"))
    json["id"] = {{"writer", node.instance()}, {"number", goal ? 1 : bus::next_request_number()}};
  const char* const requester = goal ? "requester" : "source";
  if (!json.contains(requester))
    json[requester] = person("saphira write");
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Holds samples of QoS goal or latched until Ctrl-C or for the given time; writes others once, as
/// soon as the running readers have matched.
int tell(const WriteOptions& options, const std::string& qos, const bus::NodeOptions& node_options,
         const bus::Stop& stop) {
  const bool holds = qos == "goal" || qos == "latched";
  Samples samples(options.json);
  bus::Node node(node_options);
  bus::Scribe scribe(node, options.topic);
  Gathering readers;
  bool written = false;
  const auto began = Clock::now();
  while (!stop.requested() && !samples.ended()) {
    const std::size_t matched = scribe.matched();
    if (!holds && !readers.complete(matched, seconds_since(began))) {
      if (matched == 0 && seconds_since(began) > kNobodyReads) {
        complain("saphira: not written: no program reads %s of robot %s in domain %u\n",
                 options.topic.c_str(), node_options.robot.c_str(), node_options.domain);
        return bus::kExitFailed;
      }
      node.wait(milliseconds(20), &stop);
      continue;
    }
    const auto line = samples.next();
    if (!line) {
      node.wait(milliseconds(50), &stop);
      continue;
    }
    if (!scribe.write(completed(options.topic, *line, node)))
      throw std::runtime_error("the bus did not take the sample");
    written = true;
  }
  if (holds && written) {
    print("%s holds it %s\n", options.topic.c_str(),
          options.seconds > 0.0 ? "for the time given" : "until Ctrl-C");
    const auto since = Clock::now();
    while (!stop.requested() && (options.seconds <= 0.0 || seconds_since(since) < options.seconds))
      node.wait(milliseconds(100), &stop);
    scribe.dispose();
  }
  scribe.wait_acknowledged(kDelivered);
  return bus::kExitOk;
}

int write(const WriteOptions& options, const bus::NodeOptions& node, const bus::Stop& stop) {
  expect_topic(options.topic);
  // People may write commands for the wheels: the bridge judges them.
  const bool commands = options.topic.starts_with("drive/") && options.topic != "drive/grant";
  if (const std::string writer = system::only_writer(options.topic);
      !writer.empty() && !commands && !options.force)
    throw std::invalid_argument(
        "not written: " + options.topic + " is written by " + writer +
        " alone, and two writers confuse its readers; --force writes it all the same");
  int code = bus::kExitOk;
  try {
    bus::for_each_topic([&](const auto& topic) {
      using Topic = std::decay_t<decltype(topic)>;
      if (options.topic != topic.name)
        return;
      if constexpr (std::is_same_v<Topic, bus::Topic<v1::MotorCommand>>)
        code = drive(options, topic, node, stop);
      else if constexpr (std::is_same_v<Topic, bus::RequestTopic>)
        code = ask(options, topic, node, stop);
      else
        code = tell(options, qos_of(options.topic), node, stop);
    });
  } catch (const std::invalid_argument& error) {
    std::cerr << "saphira: " << options.topic << ": " << error.what() << '\n';
    return bus::kExitUsage;
  }
  return code;
}

}  // namespace

void add_write(CLI::App& app, Chosen& chosen) {
  auto options = std::make_shared<WriteOptions>();
  CLI::App* command = app.add_subcommand("write", "Write on a topic, as JSON");
  command->add_option("topic", options->topic, "such as drive/direct")->required();
  command
      ->add_option("json", options->json,
                   "one object, such as '{\"velocity\": 0.2}'; - : one on each line of the input")
      ->required();
  command->add_option("--for", options->seconds, "[s] drive/..., goals: end then")
      ->check(above_zero())
      ->transform(number_in_unit("s"));
  command->add_flag("--force", options->force, "also a topic that one program writes by design");
  command->footer(
      "Members that are not named are 0, false or empty; saphira echo shows the form of a sample.\n"
      "drive/...: the robot drives for as long as this runs, and stops when it ends. goals and "
      "what is\n"
      "latched hold until Ctrl-C. Requests are answered: exit code 0 means done.");
  chosen.when(command, options, write);
}

}  // namespace saphira::cli
