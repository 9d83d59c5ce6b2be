#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <iostream>

#include "commands.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/cli/key_drive.hpp"
#include "saphira/geometry/pose.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPeriod{50};  ///< of the commands; the bridge's lease is 300 ms
constexpr int kReleases = 4;
constexpr double kConstantVelocity = 0.3;  ///< [m/s] of the key g (manual 2.3.6)

constexpr std::array kShowCursor{'\x1b', '[', '?', '2', '5', 'h', '\n'};

/// The terminal as a keyboard: keys come at once and are not echoed. Restored with the object, and
/// by the signals that end or stop a process without its destructors.
class RawTerminal {
 public:
  RawTerminal() {
    if (tcgetattr(STDIN_FILENO, &before_) != 0)
      throw std::runtime_error("drive needs a terminal for its keys");
    saved = before_;
    for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGQUIT, SIGTSTP})
      std::signal(number, restore_and_raise);
    termios raw = before_;
    raw.c_lflag &= static_cast<tcflag_t>(~(ICANON | ECHO | ISIG));
    raw.c_iflag &= static_cast<tcflag_t>(~(IXON | ICRNL));
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    std::fputs("\x1b[?25l", stdout);
  }
  ~RawTerminal() {
    tcsetattr(STDIN_FILENO, TCSANOW, &before_);
    std::fputs("\x1b[?25h\n", stdout);
    std::fflush(stdout);
  }
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

 private:
  static void restore_and_raise(int number) {
    tcsetattr(STDIN_FILENO, TCSANOW, &saved);
    [[maybe_unused]] const auto written =
        write(STDOUT_FILENO, kShowCursor.data(), kShowCursor.size());
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
  static termios saved;
  termios before_{};
};
termios RawTerminal::saved{};

class Teleop {
 public:
  explicit Teleop(const bus::NodeOptions& options)
      : node_(options),
        processes_(node_),
        goals_(node_, "saphira drive"),
        commands_(node_.writer(bus::topics::kDriveTeleop)),
        robots_(node_.reader(bus::topics::kRobotState)),
        descriptions_(node_.reader(bus::topics::kRobotDescription)),
        grants_(node_.reader(bus::topics::kGrant)) {
    source_ = "keyboard";
    if (const char* user = getlogin())
      source_ += std::string(" of ") + user;
  }

  int run(const bus::Stop& stop) {
    const RawTerminal terminal;
    std::fputs(
        "i/up faster   m/down slower   j/left   l/right   k/space all stop   . or return: go on\n"
        "g constant velocity on/off   c obstacle avoidance   q quit\n"
        "Keep a key down: without keys the robot stops.\n\n",
        stdout);
    auto due = Clock::now();
    while (!stop.requested() && !quit_) {
      std::array<pollfd, 3> fds{
          {{STDIN_FILENO, POLLIN, 0}, {stop.fd(), POLLIN, 0}, {node_.wake_fd(), POLLIN, 0}}};
      const auto left = std::chrono::ceil<milliseconds>(due - Clock::now());
      poll(fds.data(), fds.size(), static_cast<int>(std::max<long>(0, left.count())));
      if ((fds[0].revents & (POLLHUP | POLLERR)) != 0)
        break;  // the terminal is gone
      if ((fds[0].revents & POLLIN) != 0 && !read_keys())
        break;
      node_.clear_wake();
      take();
      if (Clock::now() >= due) {
        send();
        show();
        due += kPeriod;
        if (due < Clock::now())
          due = Clock::now() + kPeriod;
      }
    }
    finish();
    return bus::kExitOk;
  }

 private:
  static double now() {
    return BootClock::seconds();  // a key that was held before the machine slept is not held now
  }

  /// False when the terminal has been closed.
  bool read_keys() {
    std::array<char, 256> buffer{};
    const ssize_t n = read(STDIN_FILENO, buffer.data(), buffer.size());
    if (n == 0)
      return false;
    if (n > 0)
      input_.append(buffer.data(), static_cast<std::size_t>(n));
    for (const DriveKey key : take_keys(input_))
      press(key);
    return true;
  }

  void press(DriveKey key) {
    switch (key) {
      case DriveKey::quit:
        quit_ = true;
        return;
      case DriveKey::avoidance:
        note_ =
            "the guard beside the robot always holds for the keyboard; it is the bridge's, and "
            "is not switched from here";
        return;
      case DriveKey::constant:
        toggle_constant();
        return;
      default:
        break;
    }
    note_.clear();
    if (!robot_)
      return;  // nobody drives what he has not seen
    end_constant();
    keys_.press(key, now());
    send();  // at once: a stop does not wait for the period
  }

  /// g: the goal drive, so that the behaviors keep the speed and avoid what is in the way.
  void toggle_constant() {
    if (constant_) {
      end_constant();
      note_ = "constant velocity off";
      return;
    }
    keys_.release();
    v1::Goal goal;
    goal.functor("drive");
    goal.arguments({bus::number("speed", kConstantVelocity)});
    constant_ = goals_.ask(goal);
    note_ = "constant velocity on: the behaviors drive, avoiding what is in the way";
  }

  void end_constant() {
    if (constant_)
      goals_.cancel(*constant_);
    constant_.reset();
  }

  void take() {
    processes_.poll();
    goals_.poll();
    if (const auto robot = robots_.take_newest()) {
      robot_ = *robot;
      robot_came_ = Clock::now();
    }
    if (const auto description = descriptions_.take_newest())
      keys_.set_max_velocity(description->max_velocity());
    if (const auto grant = grants_.take_newest()) {
      grant_ = *grant;
      for (const v1::Refusal& refusal : grant->refused())
        if (refusal.role() == v1::ROLE_TELEOP) {
          refusal_ = refusal.source() + ": " + refusal.reason();
          refused_at_ = Clock::now();
        }
    }
    if (constant_)
      if (const auto status = goals_.status(*constant_)) {
        if (bus::ended(status->state())) {
          note_ = "constant velocity " + bus::describe(*status);
          constant_.reset();
        }
      }
  }

  void send() {
    const KeyDrive::Setpoint setpoint = keys_.setpoint(now());
    // The release is said several times: the topic is best effort.
    if (setpoint.active)
      releases_left_ = kReleases;
    else if (releases_left_ > 0)
      --releases_left_;
    else
      return;
    write(setpoint);
  }

  void write(const KeyDrive::Setpoint& setpoint) {
    v1::MotorCommand command;
    // The stamp says which picture of the robot the person has: an old one is refused.
    if (robot_)
      command.stamp(robot_->stamp());
    command.source(source_);
    command.number(++number_);
    command.active(setpoint.active);
    command.translation(v1::TRANSLATION_VELOCITY);
    command.velocity(setpoint.velocity);
    command.rotation(v1::ROTATION_RELATIVE_HEADING);
    command.heading(setpoint.heading);
    // Unique over restarts of this program too, or the bridge would take the first for an old one.
    command.move(node_.instance() + setpoint.move);
    commands_.write(command);
  }

  void show() {
    const KeyDrive::Setpoint setpoint = keys_.setpoint(now());
    std::array<char, 256> text{};
    std::string line;
    if (!robot_ || seconds_since(robot_came_) > 1.0) {
      line = "no robot: " + who_is_there(node_.options(), processes_);
    } else {
      std::snprintf(
          text.data(), text.size(),
          "want %+.2f m/s  is %+.2f m/s %+4.0f deg/s  at (%.2f, %.2f) %4.0f deg  %.1f V%s%s",
          setpoint.velocity, robot_->velocity(), degrees(robot_->rotation_velocity()),
          robot_->pose_in_odom().x(), robot_->pose_in_odom().y(),
          degrees(robot_->pose_in_odom().th()), robot_->battery(),
          robot_->left_stalled() ? "  LEFT STALLED" : "",
          robot_->right_stalled() ? "  RIGHT STALLED" : "");
      line = text.data();
    }
    const bool still = setpoint.velocity == 0.0 && setpoint.heading == 0.0;
    std::string second = !setpoint.active ? "released" : still ? "holding still" : "driving";
    if (grant_)
      second += "  |  " + describe(*grant_);
    std::string third = note_;
    if (!refusal_.empty() && seconds_since(refused_at_) < 2.0)
      third = "refused: " + refusal_;
    // Three lines, each cut to the terminal, so that the cursor can go back up over them.
    winsize size{};
    const std::size_t width =
        ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1U : 79U;
    std::string out = drawn_ ? "\x1b[2F" : "";
    bool first = true;
    for (const std::string* each : {&line, &second, &third}) {
      out += first ? "\r\x1b[K" : "\n\x1b[K";
      first = false;
      out += each->substr(0, width);
    }
    drawn_ = true;
    std::fputs(out.c_str(), stdout);
    std::fflush(stdout);
  }

  /// The grant is given back, which stops the robot.
  void finish() {
    keys_.release();
    while (releases_left_ > 0) {
      send();
      node_.wait(milliseconds(20));
    }
    if (constant_) {
      end_constant();
      goals_.delivered(500);
    }
  }

  bus::Node node_;
  Processes processes_;
  bus::GoalClient goals_;
  bus::Writer<v1::MotorCommand> commands_;
  bus::Reader<v1::RobotState> robots_;
  bus::Reader<v1::RobotDescription> descriptions_;
  bus::Reader<v1::Grant> grants_;

  KeyDrive keys_;
  std::string input_;
  std::string source_;
  std::uint64_t number_ = 0;
  int releases_left_ = 0;
  bool quit_ = false;
  bool drawn_ = false;
  std::optional<v1::GoalId> constant_;
  std::optional<v1::RobotState> robot_;
  Clock::time_point robot_came_;
  std::optional<v1::Grant> grant_;
  std::string refusal_;
  Clock::time_point refused_at_;
  std::string note_;
};

int drive(const bus::NodeOptions& options, const bus::Stop& stop) {
  if (isatty(STDIN_FILENO) == 0) {
    std::cerr << "saphira: drive needs a terminal for its keys\n";
    return bus::kExitUsage;
  }
  return Teleop(options).run(stop);
}

}  // namespace

void add_drive(CLI::App& app, Chosen& chosen) {
  app.add_subcommand("drive", "Drive by keyboard; the robot moves only while keys come")
      ->callback([&chosen] { chosen.run = drive; });
}

}  // namespace saphira::cli
