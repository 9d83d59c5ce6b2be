#include "os.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "saphira/base/boot_clock.hpp"
#include "saphira/behaviors/folder.hpp"
#include "saphira/transport/address.hpp"

namespace saphira::c {
namespace {

constexpr auto kPatience = std::chrono::seconds(8);  // of sfConnectToRobot
constexpr double kHung = 1.0;                        // [s] of a micro-task
constexpr double kLastPatience = 3.0;  // [s] after a signal, for a micro-task to return
constexpr double kShort = 0.05;        // [m] from the end of a position
constexpr double kStanding = 0.005;    // [m/s]
constexpr int kStandsLong = 10;        // [cycles]
constexpr int kWaits = 15;             // [100 ms] until a missing robot is reported

volatile std::sig_atomic_t signalled = 0;
void on_signal(int number) {
  signalled = number;
  std::signal(number, SIG_DFL);  // the second signal ends a hanging program
}
void mind_signal(int number) {
  struct sigaction before {};
  if (::sigaction(number, nullptr, &before) == 0 && before.sa_handler == SIG_DFL)
    std::signal(number, on_signal);
}

/// The exit handler that is registered last is called first. It is registered again after loading a
/// library, so that the robot is released before that library is unloaded.
void end_at_exit() {
  std::atexit([] { Os::get().finish(); });
}

}  // namespace

void show_names(const protocol::RobotIdentity& robot) {
  std::snprintf(sfRobotName, sizeof sfRobotName, "%s", robot.name.c_str());
  std::snprintf(sfRobotClass, sizeof sfRobotClass, "%s", robot.robot_class.c_str());
  std::snprintf(sfRobotSubclass, sizeof sfRobotSubclass, "%s", robot.subclass.c_str());
}

Os& Os::get() {
  static Os* const os = new Os();
  return *os;
}

void Os::say(const std::string& text, bool error) {
  std::fprintf(error ? stderr : stdout, "%s%s\n", error ? "saphira: " : "", text.c_str());
  std::fflush(error ? stderr : stdout);
}

void Os::message(const std::string& text, bool error) {
  say(text, error);
  const std::lock_guard lock(mutex);
  if (robot_)
    robot_->tell(text);
}

void Os::startup(bool async) {
  if (started_.exchange(true))
    return say("sfStartup is to be called once: this call does nothing", true);
  end_at_exit();
  mind_signal(SIGINT);
  mind_signal(SIGTERM);
  if (!async) {
    wants_robot_ = true;
    run();
    std::exit(0);
  }
  std::thread([this] { run(); }).detach();
  std::unique_lock lock(mutex);
  changed_.wait(lock, [this] { return task_thread_.load() != std::thread::id(); });
}

void Os::run() {
  own_view();
  task_thread_ = std::this_thread::get_id();
  if (on_startup)
    on_startup();
  {
    const std::lock_guard lock(mutex);
    changed_.notify_all();
  }
  std::thread([this] { watch(); }).detach();
  while (!ending_ && signalled == 0) {
    std::shared_ptr<Robot> robot;
    {
      std::unique_lock lock(mutex);
      if (!robot_ && wants_robot_ && !explicit_) {
        const char* const port = std::getenv("SAPHIRA_PORT");
        std::string address = robot_of_environment();
        if (address.empty())
          address = port != nullptr && *port != '\0' ? port : transport::default_address();
        try {
          robot_ = robot_at(address, [this](const std::string& t, bool e) { say(t, e); });
          end_at_exit();
        } catch (const std::exception& error) {
          const char* const variable = address == port ? "SAPHIRA_PORT: " : "";
          say(variable + std::string(error.what()), true);
          wants_robot_ = false;
        }
      }
      robot = robot_;
      if (!robot)
        changed_.wait_for(lock, std::chrono::milliseconds(50));
    }
    serve(robot);
  }
  idle_ = true;
  if (signalled != 0 && !ending_) {
    say(robot_ ? "interrupted: the robot is stopped" : "interrupted", false);
    std::exit(128 + signalled);
  }
}

/// One cycle, if one comes.
void Os::serve(const std::shared_ptr<Robot>& robot) {
  idle_ = false;
  std::optional<Reflected> now;
  if (robot)
    now = robot->next(100);
  const std::uint64_t session = now ? now->session : robot ? robot->session() : 0;
  if (session != session_ && session_ != 0)
    session_ended();
  if (now && session_ == 0)
    session_began(robot);
  if (now && !ending_)
    step(*now);
  if (robot && !now && session_ == 0 && !explicit_ && ++waits_ == kWaits) {
    say("no robot yet: " + robot->trouble() +
            (robot_of_environment().empty()
                 ? ". Start saphira-sim, or say in SAPHIRA_PORT where the robot is"
                 : ". Is it up? (saphira status)"),
        true);
  }
  idle_ = true;
}

void Os::session_began(const std::shared_ptr<Robot>& robot) {
  end_at_exit();
  {
    const std::lock_guard lock(mutex);
    reset();
    session_ = robot->session();
    parameters = robot->parameters();
    show_names(robot->identity());
    flakey_radius = static_cast<float>(parameters.radius * 1000.0);
    sfFrontMaxRange = static_cast<float>(parameters.front_max_range * 1000.0);
    lps = lps::LocalPerceptualSpace(model_of(parameters).lps);
  }
  behaviors_ = std::make_unique<behaviors::Core>();
  interpretation_ = std::make_unique<interpretation::Core>();
  schemas_ = {};
  try {
    schemas_ = behaviors::load_behaviors(configuration() + "/behaviors");
  } catch (const std::exception& error) {
    say(error.what(), true);
  }
  register_behaviors(schemas_);
  connected_ = true;
  if (starts_basic_procs)
    sfInitBasicProcs();
  if (on_connect)
    on_connect();
}

void Os::session_ended() {
  {
    const std::lock_guard lock(mutex);
    session_ = 0;
    connected_ = false;
    View last = shown();
    last.robot.status = STATUS_NOT_CONNECTED;
    publish(last);
  }
  if (on_disconnect)
    on_disconnect();
  const std::lock_guard lock(mutex);
  reset();
  changed_.notify_all();
}

/// No state of one connection passes to the next.
void Os::reset() {
  for (const auto& task : tasks_)
    task->removed = true;
  for (const auto& closure : closures)
    closure->removed = true;
  let_go();
  travelled = 0.0;
  max_velocity = 0.0;
  first_ = true;
  behaviors_began_ = false;
  interpretation_began_ = false;
  behaviors_drive_ = false;
  percepts_.reset();
  registration_.reset();
  map_revision_ = 0;
  current_environment = nullptr;
}

void Os::step(const Reflected& now) {
  std::shared_ptr<Robot> robot;
  {
    const std::lock_guard lock(mutex);
    ++cycle;
    clamp(now.state);
    robot = robot_;
    if (robot) {
      std::uint64_t count = 0;
      robot->vision(count);
      seen_times_.push_back({BootClock::seconds(), count});
      while (seen_times_.front().first < seen_times_.back().first - 1.0)
        seen_times_.pop_front();
    }
    publish(shown());
    update_points();
    behaviors_said_ = {};
    replaced_.clear();
  }
  take_keys();
  if (robot && robot->take_stop())
    hear_stop();
  if (robot)
    give_way(robot->take_driver());
  if (robot)
    for (const Vec2& at : robot->pointed_out())
      click(relative(robot_in_odom, Pose{at.x(), at.y(), 0.0}).position());
  run_tasks();
  const std::lock_guard lock(mutex);
  first_ = false;
  new_frame_ = false;
  const bool drives = !stopped && (motion.translation != reflector::Translation::none ||
                                   motion.rotation != reflector::Rotation::none);
  if (robot && find(motor_proc) != nullptr && !suspended(motor_proc) && drives) {
    go_on_to_position();
    robot->drive(motion, now.state.cycle);
  }
  if (robot) {
    std::vector<Drawn> drawn = take_drawn();
    if (!suspended(draw_proc))
      robot->draw(std::move(drawn));
    share(*robot, now.state.cycle);
  }
  changed_.notify_all();
}

/// Somebody has stopped the robot: the program's motion of before is over.
void Os::hear_stop() {
  const std::lock_guard lock(mutex);
  position_dropped = position_dropped || position_target.has_value();
  let_go();
  stopped = true;
  const bool has_behaviors =
      std::any_of(closures.begin(), closures.end(), [](const auto& one) { return !one->removed; });
  if (sfBehaviorControl != 0 && has_behaviors) {
    sfBehaviorControl = 0;
    behaviors_drive_ = false;
    say("the behaviors do not drive any more: sfBehaviorControl = 1 lets them drive again", false);
  }
}

/// A person has taken the wheels: a way from there is another one.
void Os::give_way(const std::string& driver) {
  const std::lock_guard lock(mutex);
  if (driver.empty() || !position_target)
    return;
  let_go();
  position_dropped = true;
  say(driver + " has driven the robot: the way of sfSetPosition is over", false);
}

void Os::let_go() {
  motion = {};
  position_target.reset();
  stopped = false;
}

/// Commands the rest of a way again after a stop on it (by an operator, the guard or a suspended
/// motor_proc).
void Os::go_on_to_position() {
  const double rest = position_target ? *position_target - travelled : 0.0;
  stands_ = motion.translation == reflector::Translation::position && std::abs(rest) > kShort &&
                    std::abs(state.information.velocity) < kStanding
                ? stands_ + 1
                : 0;
  if (stands_ < kStandsLong)
    return;
  stands_ = 0;
  motion.distance = rest;
  ++motion.move;
}

bool Os::connect(const std::string& address) {
  std::shared_ptr<Robot> robot;
  try {
    robot = robot_at(address, [this](const std::string& t, bool e) { say(t, e); });
    end_at_exit();
  } catch (const std::exception& error) {
    say(error.what(), true);
    return false;
  }
  disconnect();
  {
    const std::lock_guard lock(mutex);
    explicit_ = true;
    robot_ = robot;
    changed_.notify_all();
  }
  const auto until = std::chrono::steady_clock::now() + kPatience;
  const auto there = [this] { return connected_ && cycle > 0 && session_ != 0 && !first_; };
  if (on_task_thread()) {
    while (!there() && std::chrono::steady_clock::now() < until)
      serve(robot);
  } else {
    std::unique_lock lock(mutex);
    changed_.wait_until(lock, until, there);
  }
  if (there())
    return true;
  say("no robot at " + address + ": " + robot->trouble(), true);
  disconnect();
  return false;
}

void Os::stop_robot() {
  const std::lock_guard lock(mutex);
  let_go();
  position_dropped = false;
  motion.translation = reflector::Translation::velocity;
  motion.rotation = reflector::Rotation::velocity;
  if (robot_)
    robot_->stop();
}

void Os::disconnect() {
  std::shared_ptr<Robot> robot;
  {
    const std::lock_guard lock(mutex);
    robot = std::exchange(robot_, nullptr);
    explicit_ = true;
    connected_ = false;
  }
  if (!robot)
    return;
  robot->end();
  if (on_task_thread()) {
    if (session_ != 0)
      session_ended();
    return;
  }
  std::unique_lock lock(mutex);
  changed_.wait_for(lock, std::chrono::seconds(2), [this] { return session_ == 0; });
}

void Os::pause(int milliseconds) {
  if (started_ && on_task_thread())
    return say(
        "sfPause in a micro-task or a callback would stop all of them: it is passed over. "
        "A micro-task waits with process_state = -n",
        true);
  if (started_) {
    const std::lock_guard lock(mutex);
    wants_robot_ = true;
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds > 0 ? milliseconds : 10));
}

void Os::finish() {
  if (ending_.exchange(true))
    return;
  std::shared_ptr<Robot> robot;
  {
    const std::lock_guard lock(mutex);
    robot = robot_;
  }
  if (robot)
    robot->end();
  for (int i = 0; i < 20 && !idle_ && !on_task_thread(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

/// Reports the hanging function: the thread of the micro-tasks cannot. The robot stands by then:
/// its packets had no answer for longer than the lease. A signal ends the program all the same.
void Os::watch() {
  std::optional<double> ends_at;
  while (!ending_) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (signalled != 0 && !ends_at)
      ends_at = BootClock::seconds() + kLastPatience;
    if (ends_at && BootClock::seconds() >= *ends_at && !ending_) {
      say("interrupted, and a micro-task does not return: the robot is stopped, the program is "
          "ended without its exit handlers",
          true);
      finish();
      std::_Exit(128 + signalled);
    }
    const std::lock_guard lock(mutex);
    if (watched_.since == 0.0 || watched_.told || BootClock::seconds() - watched_.since < kHung)
      continue;
    watched_.told = true;
    say("micro-task \"" + watched_.name +
            "\" has not returned for 1 s: the robot was stopped, and all micro-tasks wait for it",
        true);
  }
}

void Os::send(protocol::Bytes packet) {
  const std::lock_guard lock(mutex);
  if (robot_)
    robot_->send(std::move(packet));
}

}  // namespace saphira::c
