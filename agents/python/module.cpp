// saphira._bus: the bus for Python. The package saphira (saphira/*.py) makes of it what agents use.
//
// The interpreter's lock is released while something is waited for. Threads of the bus never call
// Python. A Bus is for the thread that made it, and for its process.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "convert.hpp"
#include "direct.hpp"
#include "endpoints.hpp"
#include "environment.hpp"
#include "run_folder.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/robot_name.hpp"
#include "saphira/bus/agent.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/cli/goal_words.hpp"
#include "saphira/situation/why.hpp"
#include "saphira/watch/inquiry.hpp"

namespace saphira::python {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPollPeriod{100};  ///< how often a wait looks for signals
constexpr milliseconds kRepeat{20};       ///< between looks at requests that are not heard
constexpr milliseconds kLeave{1000};      ///< for these, until the bus is left
constexpr double kForever = 1e9;          ///< [s] and more would not fit a clock

/// The requests. A thread writes those that no program has answered again, also while Python is at
/// something else: a stop must be heard. For one other thread; it never calls Python.
class Requests {
 public:
  explicit Requests(bus::Node& node) : node_(node) {}
  /// Waits for a moment until all that was sent is heard.
  ~Requests() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kLeave, [this] { return unheard_.empty(); });
  }
  Requests(const Requests&) = delete;
  Requests& operator=(const Requests&) = delete;

  std::uint64_t send(const std::string& topic, const v1::Request& request, double patience) {
    const std::scoped_lock lock(mutex_);
    const auto hear = [this](const v1::Answer& answer) {
      unheard_.erase(answer.number);
      told_.push_back(answer);
    };
    const std::uint64_t number = client_of(topic).send(request, hear, patience, patience);
    unheard_.insert(number);
    changed_.notify_all();
    if (!repeater_.joinable())
      repeater_ = std::jthread([this](const std::stop_token& stop) { repeat(stop); });
    return number;
  }
  void withdraw(const std::string& topic, std::uint64_t number) {
    const std::scoped_lock lock(mutex_);
    client_of(topic).withdraw(number);
    unheard_.erase(number);
  }
  /// The answers since the last call. Repeats what has to be heard by a program anew.
  std::vector<v1::Answer> take() {
    const std::scoped_lock lock(mutex_);
    poll();
    return std::exchange(told_, {});
  }

 private:
  void poll() {
    for (auto& [topic, client] : clients_)
      client.poll(BootClock::seconds());
    changed_.notify_all();
  }
  void repeat(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (changed_.wait(lock, stop, [this] { return !unheard_.empty(); }) &&
           !stop.stop_requested()) {
      poll();
      changed_.wait_for(lock, stop, kRepeat, [] { return false; });
    }
  }
  bus::RequestClient& client_of(const std::string& topic) {
    if (const auto found = clients_.find(topic); found != clients_.end())
      return found->second;
#define SAPHIRA_REQUESTS(constant, text, answers)                                          \
  if (topic == text)                                                                       \
    return clients_.try_emplace(topic, node_, bus::topics::constant, node_.options().name) \
        .first->second;
#include "saphira/bus/topics.def"
    throw py::value_error("no topic of requests \"" + topic + "\": saphira.topics has them");
  }

  bus::Node& node_;
  std::mutex mutex_;  ///< of all below
  std::condition_variable_any changed_;
  std::map<std::string, bus::RequestClient> clients_;  ///< by topic
  std::set<std::uint64_t> unheard_;                    ///< no program has answered them yet
  std::vector<v1::Answer> told_;
  std::jthread repeater_;  ///< once something is asked
};

/// The parts that live with the node.
struct Parts {
  explicit Parts(const bus::NodeOptions& options)
      : node(options), processes(node), requests(node) {}
  ~Parts() {
    if (goals)
      goals->leave();
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  bus::Node node;
  watch::Processes processes;
  Requests requests;
  std::optional<bus::GoalClient> goals;  ///< once one is asked for: not every role may
  std::optional<bus::Agent> agent;
  std::vector<v1::Request> asked;  ///< of the agent: it answers UNDERWAY, and Python the end
};

using Driver = Owned<Endpoint, cli::DirectDriver>;
using Inquiry = Owned<Endpoint, watch::Inquiry>;

/// The explanation of the robot's behavior, as JSON.
std::string explanation(Inquiry& asked, const std::string& wish) {
  if (const std::string missing = asked.kind().missing(); !missing.empty())
    throw py::index_error(missing);
  const situation::Situation known = asked.kind().situation();
  if (wish.empty())
    return to_json(situation::why(known));
  std::istringstream words(wish);
  const auto parsed = situation::parse_wish(
      {std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()});
  if (!parsed)
    throw py::value_error("expected turn left, turn right, faster or slower, found " + wish);
  return to_json(situation::why_not(known, *parsed));
}

class Bus {
 public:
  Bus(const std::string& name, const std::optional<std::string>& robot,
      const std::optional<std::uint32_t>& domain, const std::optional<std::string>& profile,
      const std::vector<std::string>& peers, const std::optional<std::string>& security,
      std::string summary)
      : summary_(std::move(summary)) {
    bus::NodeOptions options = bus::options_of_environment();
    options.name = name;
    options.program = name;
    options.robot = robot.value_or(options.robot);
    if (const std::string trouble = trouble_of_robot(options.robot); !trouble.empty())
      throw py::value_error("robot: " + trouble);
    options.domain = domain.value_or(options.domain);
    if (profile)
      options.profile = bus::profile_of(*profile);
    if (!peers.empty())
      options.peers = peers;
    options.security = security.value_or(options.security);
    const auto in_environment = [](const char* variable) {
      const char* const value = std::getenv(variable);
      return value != nullptr && *value != '\0';
    };
    const cli::GivenOptions given{
        robot || in_environment("SAPHIRA_ROBOT"), domain || in_environment("SAPHIRA_DOMAIN"),
        profile || !peers.empty() || in_environment("SAPHIRA_PROFILE") ||
            in_environment("SAPHIRA_PEERS") || in_environment("SAPHIRA_INTERFACE"),
        security || in_environment("SAPHIRA_SECURITY")};
    if (const auto meant = cli::bus_meant(cli::bus_of("", options), cli::running_buses(), given))
      options = cli::on_bus(*meant, options);
    parts_ = unlocked([&] { return std::make_unique<Parts>(options); });
  }
  ~Bus() { close(); }

  /// Leaves the bus, which ends the goals: at once, or with the owner's call that is underway.
  void close() {
    for (const auto& weak : endpoints_)
      if (const auto endpoint = weak.lock())
        endpoint->close();
    if (parts_ && !owner_.is_forked())
      parts_->node.wake();  // from a wait
    owner_.end(std::move(parts_));
  }
  bool is_open() const { return parts_ && !owner_.is_forked(); }

  const bus::NodeOptions& options() { return node().options(); }
  std::uint64_t instance() { return node().instance(); }
  int fd() { return node().wake_fd(); }
  void clear_wake() { node().clear_wake(); }

  /// False: nothing has come for so long [s]. Signals are handled meanwhile.
  bool wait(double seconds) {
    bus::Node& own = node();
    // fmin, fmax: no number is none.
    const double bounded = std::fmin(std::fmax(seconds, 0.0), kForever);
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(bounded);
    for (;;) {
      const auto left = std::chrono::ceil<milliseconds>(end - std::chrono::steady_clock::now());
      const bool came = unlocked(
          [&] { return own.wait(std::max(milliseconds(0), std::min(left, kPollPeriod))); });
      if (PyErr_CheckSignals() != 0)
        throw py::error_already_set();
      if (!parts_)
        throw std::runtime_error("the bus is closed");
      if (came || left <= kPollPeriod)
        return came;
    }
  }

  /// Takes the news of programs and goals. Call after each wait.
  void poll() {
    Parts& own = parts();
    own.processes.poll();
    if (own.goals)
      own.goals->poll();
    if (own.agent) {
      own.agent->poll();
      own.node.publish_status();
    }
  }

  std::string who_is_there() { return watch::who_is_there(parts().processes); }
  bool is_empty() { return parts().processes.all().empty(); }
  /// Why the program is not heard; empty: it is, or may still be.
  std::string absence(const std::string& program) {
    return watch::absence(node(), parts().processes, program);
  }

  py::object ask_goal(py::handle goal) {
    bus::GoalClient& own = goals();
    const auto wanted = sample_of<v1::Goal>(goal, "Goal");
    return to_python(unlocked([&] { return own.ask(wanted); }), class_of("GoalId"));
  }
  void cancel(py::handle id, const std::string& why) {
    bus::GoalClient& own = goals();
    const auto goal = sample_of<v1::GoalId>(id, "GoalId");
    unlocked([&] {
      own.cancel(goal, why);
      return 0;
    });
  }
  py::object status(py::handle id) {
    const auto status = goals().status(sample_of<v1::GoalId>(id, "GoalId"));
    return status ? to_python(*status, class_of("GoalStatus")) : py::none();
  }

  /// patience: [s] for the end; without a deadline in the request, after each answer.
  std::uint64_t send(const std::string& topic, py::handle request, double patience) {
    Requests& own = parts().requests;
    const auto asked = sample_of<v1::Request>(request, "Request");
    return unlocked([&] { return own.send(topic, asked, patience); });
  }
  void withdraw(const std::string& topic, std::uint64_t number) {
    Requests& own = parts().requests;
    unlocked([&] {
      own.withdraw(topic, number);
      return 0;
    });
  }
  py::list answers() {
    py::list list;
    for (const v1::Answer& answer : parts().requests.take())
      list.append(to_python(answer, class_of("Answer")));
    return list;
  }

  /// Announces what this program can be asked for; its requests come out of requests().
  void can(py::handle capability) {
    const auto declared = sample_of<v1::Capability>(capability, "Capability");
    agent().can(declared, [&own = parts()](const v1::Request& request) {
      own.asked.push_back(request);
      v1::Answer underway{.code = v1::ANSWER_UNDERWAY};
      return underway;
    });
  }
  py::list requests() {
    py::list list;
    for (const v1::Request& request : std::exchange(parts().asked, {}))
      list.append(to_python(request, class_of("Request")));
    return list;
  }
  void answer(py::handle request, py::handle answer) {
    agent().answer(sample_of<v1::Request>(request, "Request"),
                   sample_of<v1::Answer>(answer, "Answer"));
  }
  py::object set(py::handle trigger) {
    return to_python(agent().set(sample_of<v1::Trigger>(trigger, "Trigger")), class_of("GoalId"));
  }
  void take_back(py::handle trigger) {
    agent().take_back(sample_of<v1::GoalId>(trigger, "GoalId"));
  }
  void tell(py::handle event) {
    auto told = sample_of<v1::AgentEvent>(event, "AgentEvent");
    agent().tell(told.functor, std::move(told.arguments));
  }

  /// Drives as a program, in the role direct.
  std::shared_ptr<Driver> driver() {
    return kept(std::make_shared<Driver>(
        owner_, std::make_unique<cli::DirectDriver>(node(), bus::topics::kDriveDirect,
                                                    node().options().name)));
  }
  std::shared_ptr<Inquiry> inquiry(std::int64_t cycle) {
    return kept(std::make_shared<Inquiry>(owner_, std::make_unique<watch::Inquiry>(node(), cycle)));
  }

  std::shared_ptr<AnyReader> reader(const std::string& topic) {
    return kept(make_reader(owner_, node(), topic));
  }
  std::shared_ptr<AnyWriter> writer(const std::string& topic) {
    return kept(make_writer(owner_, node(), topic));
  }

 private:
  Parts& parts() {
    owner_.check();
    if (!parts_)
      throw std::runtime_error("the bus is closed");
    return *parts_;
  }
  bus::Node& node() { return parts().node; }

  bus::GoalClient& goals() {
    Parts& own = parts();
    if (!own.goals)
      own.goals.emplace(own.node, own.node.options().name);
    return *own.goals;
  }
  bus::Agent& agent() {
    Parts& own = parts();
    if (!own.agent) {
      own.agent.emplace(own.node, own.node.options().name, summary_);
      own.agent->when_withdrawn(
          [&own](const v1::Request& withdrawal) { own.asked.push_back(withdrawal); });
    }
    return *own.agent;
  }
  template <class Kind>
  std::shared_ptr<Kind> kept(std::shared_ptr<Kind> endpoint) {
    std::erase_if(endpoints_, [](const auto& weak) { return weak.expired(); });
    endpoints_.push_back(endpoint);
    return endpoint;
  }

  const Owner owner_;
  const std::string summary_;  ///< of the agent
  std::unique_ptr<Parts> parts_;
  std::vector<std::weak_ptr<Endpoint>> endpoints_;
};

}  // namespace
}  // namespace saphira::python

PYBIND11_MODULE(_bus, module) {
  using namespace saphira::python;
  namespace py = pybind11;
  using py::arg;
  const py::call_guard<Call> in_call;
  module.attr("version") = saphira::bus::version();
  module.def("there_and_back", &there_and_back, in_call);
  module.def("advice_after_failure", [](py::handle goal) {
    return saphira::cli::advice_after_failure(sample_of<saphira::v1::Goal>(goal, "Goal"));
  });
  py::class_<AnyReader, std::shared_ptr<AnyReader>>(module, "Reader")
      .def("take", &AnyReader::take, in_call)
      .def("matched", &AnyReader::matched, in_call)
      .def("close", &AnyReader::close, in_call);
  py::class_<AnyWriter, std::shared_ptr<AnyWriter>>(module, "Writer")
      .def("write", &AnyWriter::write, in_call)
      .def("dispose", &AnyWriter::dispose, in_call)
      .def("matched", &AnyWriter::matched, in_call)
      .def("close", &AnyWriter::close, in_call);
  py::class_<Driver, std::shared_ptr<Driver>>(module, "Driver")
      .def(
          "drive",
          [](Driver& driver, py::handle command) {
            driver.kind().drive(sample_of<saphira::v1::MotorCommand>(command, "MotorCommand"));
          },
          in_call)
      .def(
          "release",
          [](Driver& driver) {
            auto& own = driver.kind();
            unlocked([&] {
              own.release();
              return 0;
            });
          },
          in_call)
      .def(
          "poll", [](Driver& driver) { driver.kind().poll(); }, in_call)
      .def(
          "drives", [](Driver& driver) { return driver.kind().drives(); }, in_call)
      .def(
          "trouble", [](Driver& driver) { return driver.kind().trouble(); }, in_call)
      .def(
          "stopped_by", [](Driver& driver) { return driver.kind().stopped_by(); }, in_call)
      .def("close", &Driver::close, in_call);
  py::class_<Inquiry, std::shared_ptr<Inquiry>>(module, "Inquiry")
      .def(
          "poll", [](Inquiry& asked) { return asked.kind().poll(); }, in_call)
      .def("explanation", &explanation, in_call)
      .def("close", &Inquiry::close, in_call);
  py::class_<Bus>(module, "Bus")
      .def(py::init<const std::string&, const std::optional<std::string>&,
                    const std::optional<std::uint32_t>&, const std::optional<std::string>&,
                    const std::vector<std::string>&, const std::optional<std::string>&,
                    std::string>(),
           arg("name"), arg("robot"), arg("domain"), arg("profile"), arg("peers"), arg("security"),
           arg("summary"))
      .def("close", &Bus::close, in_call)
      .def("is_open", &Bus::is_open, in_call)
      .def(
          "name", [](Bus& bus) { return bus.options().name; }, in_call)
      .def(
          "robot", [](Bus& bus) { return bus.options().robot; }, in_call)
      .def(
          "domain", [](Bus& bus) { return bus.options().domain; }, in_call)
      .def("instance", &Bus::instance, in_call)
      .def("fd", &Bus::fd, in_call)
      .def("clear_wake", &Bus::clear_wake, in_call)
      .def("wait", &Bus::wait, in_call)
      .def("poll", &Bus::poll, in_call)
      .def("who_is_there", &Bus::who_is_there, in_call)
      .def("is_empty", &Bus::is_empty, in_call)
      .def("absence", &Bus::absence, in_call)
      .def("ask_goal", &Bus::ask_goal, in_call)
      .def("cancel", &Bus::cancel, in_call)
      .def("status", &Bus::status, in_call)
      .def("send", &Bus::send, in_call)
      .def("withdraw", &Bus::withdraw, in_call)
      .def("answers", &Bus::answers, in_call)
      .def("can", &Bus::can, in_call)
      .def("requests", &Bus::requests, in_call)
      .def("answer", &Bus::answer, in_call)
      .def("set", &Bus::set, in_call)
      .def("take_back", &Bus::take_back, in_call)
      .def("tell", &Bus::tell, in_call)
      .def("driver", &Bus::driver, in_call)
      .def("inquiry", &Bus::inquiry, in_call)
      .def("reader", &Bus::reader, in_call)
      .def("writer", &Bus::writer, in_call);
}
