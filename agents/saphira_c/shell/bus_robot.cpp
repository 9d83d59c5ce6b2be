// The part of the C library that joins the bus (SAPHIRA_ROBOT): the robot is the bridge's, the
// interpretation of its sensors is the services', and the program is one of those that may drive it
// (role direct).

#include "bus_robot.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "convert.hpp"
#include "geometry/shell/convert.hpp"
#include "lps/shell/convert.hpp"
#include "maps/shell/convert.hpp"
#include "saphira.h"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/identity.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/bus/stop_notice.hpp"
#include "saphira/runtime/processes.hpp"

namespace saphira::c {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kTurn{20};
constexpr double kSilent = 1.0;  // [s] of silence that ends the robot
constexpr int kReleases = 4;     // repetitions of a release: the topic is best effort

bus::NodeOptions options_of(const std::string& robot) {
  bus::NodeOptions options = bus::options_of_environment();
  options.robot = robot;
  options.name = program_invocation_short_name;
  options.program = "agent";
  return options;
}

class BusRobot final : public Robot {
 public:
  BusRobot(bus::NodeOptions options, Say say, std::shared_ptr<bus::MemoryBus> memory)
      : options_(std::move(options)), memory_(std::move(memory)), say_(std::move(say)) {
    trouble_ = "no bridge of robot \"" + options_.robot + "\" is heard";
    thread_ = std::thread([this] { run(); });
  }
  ~BusRobot() override { end(); }

  void drive(const reflector::Motion& motion, std::uint64_t cycle) override {
    const std::lock_guard lock(mutex_);
    if (was_stopped_)
      return;
    wish_ = command_of(motion);
    wish_->stamp.epoch = epoch_;
    wish_->stamp.cycle = cycle;
    wake();
  }
  bool take_stop() override {
    const std::lock_guard lock(mutex_);
    return std::exchange(was_stopped_, false);
  }
  std::string take_driver() override {
    const std::lock_guard lock(mutex_);
    return std::exchange(driver_, {});
  }
  void stop() override { ask({bus::topics::kDriveStop, bus::request("stop")}); }
  std::optional<Found> found() override {
    const std::lock_guard lock(mutex_);
    return found_;
  }
  std::vector<TaskRequest> share(std::vector<SharedTask> tasks,
                                 std::optional<SharedMind> mind) override {
    const std::lock_guard lock(mutex_);
    shared_ = std::move(tasks);
    mind_ = std::move(mind);
    // The program's next call shows the effect of its present requests.
    unanswered_.clear();
    for (const TaskRequest& asked : asked_)
      unanswered_.insert(asked.name);
    return std::exchange(asked_, {});
  }
  void draw(std::vector<Drawn> drawn) override {
    const std::lock_guard lock(mutex_);
    if (!drawn.empty())
      drawn_ = std::move(drawn);
  }
  void tell(const std::string& text) override {
    const std::lock_guard lock(mutex_);
    told_.push_back(text.substr(0, 255));
  }
  std::vector<Vec2> pointed_out() override {
    const std::lock_guard lock(mutex_);
    return std::exchange(pointed_out_, {});
  }
  void load_map(const std::string& text, const std::string& name) override {
    ask({bus::topics::kRegistrationRequest,
         bus::request("load", {bus::text("text", text), bus::text("name", name)})});
  }
  void place(const Pose& robot) override {
    {
      const std::lock_guard lock(mutex_);
      placing_ = true;
      if (found_)
        found_->odom_in_map.reset();
    }
    ask({bus::topics::kRegistrationRequest,
         bus::request("place",
                      {bus::point("position", robot.x, robot.y, robot.th, v1::FRAME_MAP)})});
  }

 private:
  /// The endpoints on the bus, for the thread alone.
  struct Ends {
    bus::Node& node;
    bus::Reader<v1::RobotState> robots = node.reader(bus::topics::kRobotState);
    bus::Reader<v1::RobotDescription> descriptions = node.reader(bus::topics::kRobotDescription);
    bus::Reader<v1::Grant> grants = node.reader(bus::topics::kGrant);
    bus::Reader<v1::Perception> perceptions = node.reader(bus::topics::kPerception);
    bus::Reader<v1::Registration> registrations = node.reader(bus::topics::kRegistration);
    bus::Reader<v1::FloorMap> maps = node.reader(bus::topics::kMap);
    bus::Reader<v1::VisionChannels> channels = node.reader(bus::topics::kVisionChannels);
    bus::Reader<v1::AgentEvent> events = node.reader(bus::topics::kAgentEvents);
    bus::Writer<v1::MotorCommand> commands = node.writer(bus::topics::kDriveDirect);
    bus::Writer<v1::Message> messages = node.writer(bus::topics::kMessages);
    bus::Writer<v1::Drawing> drawings = node.writer(bus::topics::kDrawings);
    bus::Writer<v1::ProgramMind> minds = node.writer(bus::topics::kProgramMinds);
    std::map<std::string, bus::RequestClient> clients{};  ///< by topic
  };

  void ask(Call call) {
    const std::lock_guard lock(mutex_);
    calls_.push_back(std::move(call));
    wake();
  }
  void wake() override {
    if (node_ != nullptr)
      node_->wake();
  }

  void run() {
    try {
      serve();
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      trouble_ = error.what();
    }
    const std::lock_guard lock(mutex_);
    node_ = nullptr;
    thread_ended();
  }

  void serve() {
    bus::Node node = memory_ ? bus::Node(options_, memory_) : bus::Node(options_);
    source_ = node.options().name;
    Ends ends{node};
    for (const auto& topic : {bus::topics::kDriveStop, bus::topics::kRegistrationRequest})
      client_of(ends, topic);  // matched by the first request
    ProcessTable table;
    runtime::ProcessesOnBus processes(node, table);
    {
      const std::lock_guard lock(mutex_);
      node_ = &node;
    }
    while (true) {
      node.wait(kTurn);
      take_robot(ends);
      take_services(ends);
      take_pointed_out(ends);
      take_grant(ends);
      if (!say_all(node, ends))
        break;
      show_tasks(table, processes);
      tell_status(node);
    }
    for (int i = 0; i < kReleases; ++i) {
      v1::MotorCommand release{.stamp = stamp_};
      write(node, ends, release);
      node.wait(kTurn);
    }
  }

  void tell_status(bus::Node& node) {
    const std::lock_guard lock(mutex_);
    const bool well = session_ != 0;
    node.status().state = well ? v1::SERVICE_RUNNING : v1::SERVICE_STARTING;
    node.status().reason = well ? "a program in C" : trouble_;
    node.status().stamp = stamp_;
    node.publish_status();
  }

  void take_robot(Ends& ends) {
    for (const auto& sample : ends.descriptions.take())
      if (!sample.info.disposed)
        description_ = sample.data;
    for (const auto& sample : ends.robots.take()) {
      if (sample.info.disposed)
        continue;
      const v1::RobotState& robot = sample.data;
      if (!description_ || description_->stamp.epoch != robot.stamp.epoch)
        continue;
      heard_ = BootClock::seconds();
      stamp_ = robot.stamp;
      const std::lock_guard lock(mutex_);
      if (session_ == 0 || epoch_ != stamp_.epoch)
        begin();
      reflector::State state = state_of(robot);
      note_sonars(state);
      cycle_began(state);
    }
    const std::lock_guard lock(mutex_);
    if (session_ != 0 && BootClock::seconds() - heard_ > kSilent)
      session_lost("the robot's bridge is not heard any more");
  }

  /// Call under the mutex.
  void begin() {
    parameters_ = parameters_of(*description_);
    identity_ = {parameters_.name, parameters_.robot_class, parameters_.subclass};
    epoch_ = stamp_.epoch;
    session_ = ++sessions_;
    readings_.clear();
    buckets_.clear();
    wish_.reset();
    found_ = Found{};
    trouble_.clear();
  }

  /// The newest reading of each sonar, as the reflector has it (manual 6.3.2).
  void note_sonars(reflector::State& state) {
    if (state.odom != odom_)
      buckets_.clear();
    odom_ = state.odom;
    for (const protocol::Sonar& sonar : state.information.sonars) {
      const auto unit = std::ranges::find_if(
          parameters_.sonars, [&](const auto& each) { return each.number == sonar.number; });
      if (unit == parameters_.sonars.end())
        continue;
      buckets_[sonar.number] = {sonar, state.cycle, state.pose_in_odom,
                                transform(unit->pose_in_robot, Vec2(sonar.range, 0.0))};
    }
    for (const auto& [number, bucket] : buckets_)
      state.buckets.push_back(bucket);
  }

  void take_services(Ends& ends) {
    const auto perception = ends.perceptions.take_newest();
    const auto registration = ends.registrations.take_newest();
    const auto map = ends.maps.take_newest();
    const auto channels = ends.channels.take_newest();
    const std::lock_guard lock(mutex_);
    if (channels) {
      seen_ = seen_in(*channels);
      ++seen_count_;
    }
    if (map)
      map_ = std::make_shared<const maps::Map>(maps::from_bus(*map));
    if (!found_)
      return;
    if (perception && perception->odom == odom_) {
      found_->left_wall = percept(*perception, perception->left_wall);
      found_->right_wall = percept(*perception, perception->right_wall);
    }
    if (registration && registration->odom == odom_) {
      found_->environment = registration->environment;
      if (registration->state == v1::REGISTRATION_TRACKING && !placing_)
        found_->odom_in_map = from_bus(registration->odom_in_map);
    }
    found_->map = map_;
  }
  void take_pointed_out(Ends& ends) {
    for (const auto& sample : ends.events.take()) {
      const auto& arguments = sample.data.arguments;
      if (sample.data.functor != "pointed_out" || arguments.empty() ||
          arguments.front().kind != v1::ARGUMENT_POINT)
        continue;
      const Pose at = from_bus(arguments.front().point);
      const std::lock_guard lock(mutex_);
      if (arguments.front().frame == v1::FRAME_ODOM)
        pointed_out_.push_back(at.position());
      else if (found_ && found_->odom_in_map)
        pointed_out_.push_back(relative(*found_->odom_in_map, at).position());
    }
  }
  static std::optional<lps::Percept> percept(const v1::Perception& perception, std::uint32_t id) {
    for (const v1::Percept& each : perception.percepts)
      if (id != 0 && each.id == id)
        return lps::from_bus(each);
    return std::nullopt;
  }

  /// Reports a refusal of the bridge and a stop by the guard, each kind once.
  void take_grant(Ends& ends) {
    const auto grant = ends.grants.take_newest();
    if (!grant)
      return;
    take_stop(ends, *grant);
    const bool drives = is_named(grant->source, source_);
    if (std::exchange(drives_, drives) && grant->role == v1::ROLE_TELEOP) {
      const std::lock_guard lock(mutex_);
      driver_ = grant->source;
    }
    // A driver that asked under an emergency stop has to let go once after its reset.
    if (std::exchange(estopped_, grant->estopped) && !grant->estopped)
      write(ends.node, ends, {.stamp = stamp_});
    std::string news;
    for (const v1::Refusal& refusal : grant->refused)
      if (is_named(refusal.source, source_))
        news = "the robot's bridge refuses to drive: " + refusal.reason;
    if (is_named(grant->source, source_) && grant->guard == v1::GUARD_STOP)
      news = "the guard stops the robot: " + grant->guard_reason;
    if (is_named(grant->source, source_) && grant->guard == v1::GUARD_LIMIT &&
        !std::exchange(told_limit_, true))
      say_("the guard limits the robot: " + grant->guard_reason, false);
    // Distances in a reason change all the time: only a new kind of trouble is news.
    const std::string kind = news.substr(0, news.find_first_of("0123456789"));
    if (kind != news_ && !news.empty())
      say_(news, false);
    news_ = kind;
  }

  /// A stop since this program joined the bus. It lets go; commands are dropped until take_stop().
  void take_stop(Ends& ends, const v1::Grant& grant) {
    const std::string who = notice_.hear(grant);
    if (who.empty())
      return;
    if (!is_named(grant.stop_source, source_)) {
      {
        const std::lock_guard lock(mutex_);
        wish_.reset();
        was_stopped_ = true;
      }
      say_("stopped by " + who + ": sfSetVelocity(0) comes before driving again", false);
    }
    v1::MotorCommand release{.stamp = stamp_};
    write(ends.node, ends, release);
  }

  void write(bus::Node& node, Ends& ends, v1::MotorCommand command) {
    command.source = source_;
    command.number = ++number_;
    // Unique over restarts too, or the bridge would take the first for an old one.
    command.move = node.instance() + command.move;
    ends.commands.write(command);
  }

  /// Writes the program's pending commands, requests and texts to the bus. False where it ends.
  bool say_all(bus::Node& node, Ends& ends) {
    std::optional<v1::MotorCommand> wish;
    std::vector<protocol::Bytes> packets;
    std::vector<Call> calls;
    std::vector<std::string> told;
    std::vector<Drawn> drawn;
    std::optional<SharedMind> mind;
    {
      const std::lock_guard lock(mutex_);
      wish = std::exchange(wish_, std::nullopt);
      packets = std::exchange(packets_, {});
      calls = std::exchange(calls_, {});
      told = std::exchange(told_, {});
      drawn = std::exchange(drawn_, {});
      mind = std::exchange(mind_, std::nullopt);
      if (ending_)
        return false;
    }
    if (wish)
      write(node, ends, *wish);
    for (const protocol::Bytes& packet : packets)
      call_device(ends, packet);
    for (Call& call : calls)
      send_call(ends, std::move(call));
    for (auto& [topic, client] : ends.clients)
      client.poll(BootClock::seconds());
    for (const std::string& text : told) {
      ends.messages.write({.stamp = stamp_, .source = source_, .text = text});
    }
    if (mind) {
      v1::ProgramMind sample = mind_of(*mind);
      v1::Stamp stamp = stamp_;
      stamp.cycle = mind->cycle;
      sample.instance = node.instance();
      sample.source = source_;
      sample.stamp = stamp;
      sample.behaviors.stamp = stamp;
      sample.intended.stamp = stamp;
      ends.minds.write(sample);
    }
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      v1::Drawing drawing = drawing_of(drawn[i]);
      drawing.instance = node.instance();
      drawing.number = i;
      drawing.source = source_;
      ends.drawings.write(drawing);
    }
    return true;
  }

  void call_device(Ends& ends, const protocol::Bytes& packet) {
    auto call = device_call(packet);
    if (!call) {
      say_("command " + std::to_string(packet.size() > 3 ? packet[3] : 0) +
               " is not for the bus: its bridge keeps the packets of the robot (docs/requests.md "
               "lists its requests)",
           true);
      return;
    }
    send_call(ends, *std::move(call));
  }
  bus::RequestClient& client_of(Ends& ends, const bus::RequestTopic& topic) {
    return ends.clients.try_emplace(topic.name, ends.node, topic, source_).first->second;
  }
  void send_call(Ends& ends, Call call) {
    const bool of_map = std::string_view(call.topic.name) == bus::topics::kRegistrationRequest.name;
    const auto hear = [this, of_map](const v1::Answer& answer) {
      if (!bus::well(answer.code))
        say_("the robot does not do it: " + answer.text, true);
      const std::lock_guard lock(mutex_);
      placing_ = placing_ && !(of_map && bus::ended(answer.code));
    };
    client_of(ends, call.topic).send(std::move(call.request), hear);
  }

  /// Shows the states of the program's micro-tasks, and takes requests from the bus to change them.
  void show_tasks(ProcessTable& table, runtime::ProcessesOnBus& processes) {
    std::vector<SharedTask> shared;
    std::set<std::string> busy;
    {
      const std::lock_guard lock(mutex_);
      shared = shared_;
      busy = unanswered_;
      for (const TaskRequest& asked : asked_)
        busy.insert(asked.name);
    }
    std::map<std::string, int> wanted;
    for (const SharedTask& task : shared) {
      if (busy.contains(task.name)) {
        wanted[task.name] = table.find(task.name)->state();
        continue;
      }
      Process* process = table.find(task.name);
      if (process == nullptr)
        process = &table.add(task.name, task.effect, [](Process&) {});
      const bool known = task.state <= kInterrupt || task.state >= kFirstOwnState;
      const int state = known && task.state >= 0 ? task.state : kSuspend;
      if (process->state() != state)
        process->set_state(state);
      wanted[task.name] = state;
    }
    for (const Process* const gone : table.processes())
      if (!wanted.contains(gone->name()) && !gone->suspended())
        table.find(gone->name())->suspend();
    processes.idle();
    const std::lock_guard lock(mutex_);
    for (const auto& [name, state] : wanted) {
      const int now = table.find(name)->state();
      if (now == state)
        continue;
      const ProcessAction action = now == kResume      ? ProcessAction::resume
                                   : now == kInterrupt ? ProcessAction::interrupt
                                                       : ProcessAction::suspend;
      asked_.push_back({name, action});
    }
  }

  const bus::NodeOptions options_;
  const std::shared_ptr<bus::MemoryBus> memory_;
  Say say_;

  // The thread's members.
  std::string source_;
  std::optional<v1::RobotDescription> description_;
  v1::Stamp stamp_;
  double heard_ = 0.0;
  std::uint64_t number_ = 0;
  std::string news_;
  bool told_limit_ = false;
  bool estopped_ = false;  // by the newest grant
  bool drives_ = false;    // likewise
  bus::StopNotice notice_;

  // Shared with the program's thread, as those of Robot.
  bus::Node* node_ = nullptr;
  std::uint64_t sessions_ = 0;
  std::uint64_t epoch_ = 0;
  std::uint64_t odom_ = 0;
  std::map<int, reflector::Bucket> buckets_;
  std::optional<v1::MotorCommand> wish_;
  bool was_stopped_ = false;  // since take_stop()
  std::string driver_;        // since take_driver()
  std::vector<Call> calls_;
  std::vector<std::string> told_;
  std::vector<Drawn> drawn_;
  std::vector<SharedTask> shared_;
  std::optional<SharedMind> mind_;
  std::vector<Vec2> pointed_out_;
  std::vector<TaskRequest> asked_;    // for the program
  std::set<std::string> unanswered_;  // micro-tasks with an open request
  std::optional<Found> found_;
  bool placing_ = false;  // registration has not answered yet: its pose is the one before
  std::shared_ptr<const maps::Map> map_;
};

}  // namespace

std::unique_ptr<Robot> robot_on_bus(bus::NodeOptions options, Say say,
                                    std::shared_ptr<bus::MemoryBus> memory) {
  return std::make_unique<BusRobot>(std::move(options), std::move(say), std::move(memory));
}

}  // namespace saphira::c

extern "C" __attribute__((visibility("default"))) saphira::c::Robot* saphira_c_bus_robot(
    const std::string& name, saphira::c::Say say) {
  return saphira::c::robot_on_bus(saphira::c::options_of(name), std::move(say)).release();
}
