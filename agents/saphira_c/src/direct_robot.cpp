// The thread with the connection to a robot server: the bridge's shell without the bus.

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <utility>
#include <variant>

#include "robot.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/descriptor.hpp"
#include "saphira/base/format.hpp"
#include "saphira/bridge/core.hpp"
#include "saphira/transport/keeper.hpp"
#include "saphira/transport/link.hpp"

namespace saphira::c {
namespace {

constexpr double kBeat = 0.05;  // [s] of the keeper

constexpr const char* kMargin = "SAPHIRA_GUARD_MARGIN";

/// std::invalid_argument for a wrong value.
bridge::CoreSettings settings_of_environment() {
  bridge::CoreSettings settings;
  constexpr double kLeast = 0.1;
  const char* const given = std::getenv(kMargin);
  if (given == nullptr || *given == '\0')
    return settings;
  char* end = nullptr;
  settings.guard_margin = std::strtod(given, &end);
  if (*end != '\0' || !(settings.guard_margin >= kLeast && settings.guard_margin <= 1.0))
    throw std::invalid_argument(std::string(kMargin) + ": expected 0.1 to 1 [m], not \"" + given +
                                "\"");
  return settings;
}

class DirectRobot final : public Robot {
 public:
  DirectRobot(const std::string& address, Say say)
      : say_(std::move(say)),
        link_(transport::parse_address(address)),
        settings_(settings_of_environment()),
        core_(settings_),
        wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    const std::string keeper = beside_library("bin/saphira-keeper");
    try {
      keeper_ = std::make_unique<transport::Keeper>(std::chrono::milliseconds(300), keeper);
    } catch (const std::exception& error) {
      say_(std::string(error.what()) +
               ": where this program is killed, the robot's own watchdog stops it",
           true);
    }
    thread_ = std::thread([this] { run(); });
  }
  ~DirectRobot() override { end(); }

  void drive(const reflector::Motion& motion, std::uint64_t cycle) override {
    bridge::DriveCommand wish;
    wish.command.role = authority::Role::direct;
    wish.command.source = "this program";
    wish.command.cycle = cycle;
    wish.command.active = true;
    wish.motion = motion;
    const std::lock_guard lock(mutex_);
    wish_ = wish;
    wake();
  }
  void end() override {
    Robot::end();
    keeper_.reset();
    wake_.reset();
  }

 private:
  void wake() override {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(wake_, &one, sizeof one);
  }

  void run() {
    while (true) {
      const double due = std::min(core_.due(BootClock::seconds()), link_.due());
      const double wait = std::clamp(due - BootClock::seconds(), 0.0, 0.05);
      pollfd fds[] = {{link_.fd(), link_.poll_events(), 0}, {wake_, POLLIN, 0}};
      const int n = ::poll(fds, 2, static_cast<int>(std::ceil(wait * 1000.0)));
      core_.loop(BootClock::seconds());
      deliver();
      if (n > 0 && fds[0].revents != 0)
        receive();
      if (!take())
        break;
      tend_link();
    }
    core_.end(BootClock::seconds());
    deliver();
    link_.close("the program ends");
    const std::lock_guard lock(mutex_);
    thread_ended();
  }

  /// Carries out the program's pending command and packets. False where it ends.
  bool take() {
    std::optional<bridge::DriveCommand> wish;
    std::vector<protocol::Bytes> packets;
    {
      const std::lock_guard lock(mutex_);
      std::uint64_t count = 0;
      [[maybe_unused]] const auto taken = ::read(wake_, &count, sizeof count);
      wish = std::exchange(wish_, std::nullopt);
      packets = std::exchange(packets_, {});
      if (ending_)
        return false;
    }
    const double now = BootClock::seconds();
    if (open())
      for (const protocol::Bytes& packet : packets)
        link_.write(packet, now);
    if (wish && core_.in_session()) {
      wish->command.epoch = core_.stamp().epoch;
      wish->command.number = ++number_;
      core_.command(*wish, now);
    }
    core_.answer(now);
    deliver();
    return true;
  }

  bool open() const { return link_.state() == transport::Link::State::open; }

  void receive() {
    if (!open())
      return;
    const double now = BootClock::seconds();
    std::vector<std::uint8_t> bytes;
    const bool alive = link_.read(bytes, now);
    if (!bytes.empty())
      core_.received(bytes, now);
    work();
    if (!alive) {
      core_.link_closed(link_.trouble(), now);
      deliver();
    }
  }

  void tend_link() {
    const double now = BootClock::seconds();
    core_.loop(now);
    deliver();
    if (keeper_ && now - last_beat_ >= kBeat) {
      last_beat_ = now;
      keeper_->beat();
    }
    if (core_.may_connect(now)) {
      if (!open()) {
        core_.link_closed(link_.trouble(), now);
        deliver();
      }
      link_.advance(now);
      if (!open())
        core_.link_closed(link_.trouble(), now);
    }
    bridge::Surroundings around;
    around.link_open = open();
    around.link_trouble = link_.trouble();
    around.address = link_.address().text();
    around.serial = link_.address().kind == transport::Address::Kind::serial;
    around.has_keeper = keeper_ != nullptr;
    around.keeper_alive = keeper_ && keeper_->alive();
    core_.tick(now, around);
    work();
  }

  void work() {
    deliver();
    while (core_.work(BootClock::seconds()))
      deliver();
  }

  void deliver() {
    for (std::vector<bridge::Output> outputs = core_.take(); !outputs.empty();
         outputs = core_.take())
      for (const bridge::Output& output : outputs)
        std::visit([&](const auto& what) { perform(what); }, output);
    if (open())
      core_.room(link_.room());
  }

  void perform(const bridge::Send& send) { link_.write(send.bytes, BootClock::seconds()); }
  void perform(const bridge::Answered&) { core_.answered(BootClock::seconds()); }
  void perform(const bridge::Identified& identified) {
    const double now = BootClock::seconds();
    try {
      core_.open(protocol::parameters_of(identified.robot, configuration() + "/robots"), 1, now);
    } catch (const std::exception& error) {
      core_.refuse_robot(error.what(), now);
    }
  }
  void perform(const bridge::SessionBegan& began) {
    say_("the guard stops the robot " + format("%.2f m", settings_.guard_margin) +
             " before an obstacle that its sonars hear (" + kMargin + ")",
         false);
    const std::lock_guard lock(mutex_);
    parameters_ = core_.parameters();
    identity_ = began.robot;
    next_session_ = began.stamp.epoch;
    readings_.clear();
    wish_.reset();
  }
  void perform(const bridge::CycleBegan& cycle) {
    const std::lock_guard lock(mutex_);
    session_ = next_session_;  // with the first packet: then there is a state
    cycle_began(cycle.state);
  }
  void perform(const bridge::OtherPacket& other) {
    const auto* const seen = std::get_if<protocol::VisionPacket>(&other.packet);
    if (seen == nullptr)
      return;
    const std::lock_guard lock(mutex_);
    seen_ = *seen;
    ++seen_count_;
  }
  void perform(const bridge::LaterAnswer&) {}  // nothing is asked of the devices
  void perform(const bridge::DevicesChanged&) {}
  void perform(const bridge::VisionSet&) {}
  void perform(const bridge::GrantDecided& decided) {
    const bool guards = decided.guarded.action == authority::GuardAction::stop;
    if (guards && !guarded_)
      say_("the guard stops the robot: " + decided.guarded.reason, false);
    guarded_ = guards;
    if (decided.guarded.action == authority::GuardAction::limit &&
        !std::exchange(told_limit_, true))
      say_("the guard limits the robot: " + decided.guarded.reason, false);
  }
  void perform(const bridge::WatchLink& watch) {
    if (keeper_)
      keeper_->watch(link_.fd(), watch.stop);
  }
  void perform(const bridge::CloseLink& close) {
    if (keeper_)
      keeper_->unwatch();
    link_.close(close.why, BootClock::seconds());
    const std::lock_guard lock(mutex_);
    session_lost(close.why);
  }
  void perform(const bridge::KeepLatches&) {}
  void perform(const bridge::KeepOdometry&) {}
  void perform(const v1::AuditEntry&) {}  // nobody else is there
  void perform(const bridge::StatusReport& report) {
    const std::lock_guard lock(mutex_);
    trouble_ = report.condition.reason;
  }
  void perform(const Note& note) {
    if (note.level != Note::Level::info)
      say_(note.text, true);
  }

  Say say_;
  transport::Link link_;
  bridge::CoreSettings settings_;
  bridge::Core core_;
  std::unique_ptr<transport::Keeper> keeper_;
  double last_beat_ = 0.0;
  std::uint64_t number_ = 0;
  bool guarded_ = false;
  bool told_limit_ = false;

  // Shared with the program's thread, as those of Robot.
  Descriptor wake_;
  std::uint64_t next_session_ = 0;
  std::optional<bridge::DriveCommand> wish_;
};

}  // namespace

std::unique_ptr<Robot> direct_robot(const std::string& address, Say say) {
  return std::make_unique<DirectRobot>(address, std::move(say));
}

}  // namespace saphira::c
