#include <fcntl.h>
#include <linux/joystick.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <stdexcept>

#include "commands.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/descriptor.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/cli/printer.hpp"
#include "saphira/geometry/pose.hpp"
#include "saphira/teleop/key_drive.hpp"
#include "saphira/teleop/pilot.hpp"
#include "saphira/teleop/stick_drive.hpp"
#include "watch.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;
using teleop::DriveKey;
using teleop::KeyDrive;
using teleop::Order;
using teleop::StickDrive;

constexpr milliseconds kPeriod{50};        ///< of the commands; the bridge's lease is 300 ms
constexpr double kHandBackLimit = 5.0;     ///< [s]
constexpr double kTellRefusal = 2.0;       ///< [s] that the reason is shown
constexpr double kStopAgain = 0.5;         ///< [s] between two stops of a held key
constexpr double kConstantVelocity = 0.3;  ///< [m/s] of the key g (manual 2.3.6)

constexpr const char* kKeys =
    "i/up faster   m/down slower   j/left   l/right   k/space all stop   . or return: go on\n"
    "an all stop ends whatever moves the robot: another person, goals, programs\n"
    "g constant velocity on/off   c obstacle avoidance   h hand back   q quit\n"
    "joystick: hold a shoulder button or the trigger, and push the first stick\n";

constexpr const char* kJoystick = "/dev/input/js0";

constexpr std::array kShowCursor{'\x1b', '[', '?', '2', '5', 'h', '\n'};

/// The terminal as a keyboard: keys come at once and are not echoed. Restored with the object, and
/// by the signals that end or stop a process without its destructors. Nothing here waits for a
/// terminal without a reader.
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
    print("\x1b[?25l");
  }
  ~RawTerminal() {
    tcsetattr(STDIN_FILENO, TCSANOW, &before_);
    print("\x1b[?25h\n");
  }
  RawTerminal& operator=(RawTerminal&&) = delete;

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

/// A joystick of the kernel. After unplugging, it is searched for once a second.
class Joystick {
 public:
  explicit Joystick(std::string path) : path_(std::move(path)) { open(); }

  int fd() const { return fd_; }
  bool there() const { return fd_ >= 0; }
  StickDrive& stick() { return stick_; }
  void open() {
    if (fd_ < 0)
      fd_ = ::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd_ >= 0)
      ask_layout();
  }
  /// The device, for people: the button to hold, or that it does not drive. Empty: none is there.
  std::string describe() const {
    if (!there())
      return "";
    if (stick_.dead_man().empty())
      return "the joystick does not drive: the kernel names no shoulder button, trigger or first "
             "stick of " +
             path_;
    return "a joystick: hold " + stick_.dead_man() + ", and push the first stick";
  }
  void read(double now) {
    std::array<char, 512> bytes{};
    const ssize_t n = ::read(fd_, bytes.data(), bytes.size());
    if (n > 0)
      return stick_.take({bytes.data(), static_cast<std::size_t>(n)}, now);
    if (n < 0 && (errno == EAGAIN || errno == EINTR))
      return;
    fd_.reset();
    stick_.lost();
  }

 private:
  /// A device that does not tell does not drive.
  void ask_layout() {
    std::uint8_t axes = 0;
    std::uint8_t buttons = 0;
    std::vector<std::uint8_t> axis_codes(ABS_CNT);
    std::vector<std::uint16_t> button_codes(KEY_MAX - BTN_MISC + 1);
    if (ioctl(fd_, JSIOCGAXES, &axes) < 0 || ioctl(fd_, JSIOCGBUTTONS, &buttons) < 0 ||
        ioctl(fd_, JSIOCGAXMAP, axis_codes.data()) < 0 ||
        ioctl(fd_, JSIOCGBTNMAP, button_codes.data()) < 0)
      return stick_.set_layout({}, {});
    axis_codes.resize(std::min<std::size_t>(axes, axis_codes.size()));
    button_codes.resize(std::min<std::size_t>(buttons, button_codes.size()));
    stick_.set_layout(axis_codes, button_codes);
  }

  std::string path_;
  Descriptor fd_;
  StickDrive stick_;
};

class Teleop {
 public:
  explicit Teleop(const bus::NodeOptions& options, const std::string& joystick = kJoystick)
      : joystick_(joystick), node_(options), processes_(node_), goals_(node_, "saphira drive") {}

  int run(const bus::Stop& stop) {
    const RawTerminal terminal;
    print("%s", kKeys);
    print(
        "Keep a key down: without keys the robot stops. After you have driven, goals wait until "
        "you\n"
        "hand the robot back (h, or later: saphira drive hand-back).\n\n\n\n\n");
    auto due = Clock::now();
    while (!stop.requested() && !quit_) {
      std::array<pollfd, 4> fds{{{STDIN_FILENO, POLLIN, 0},
                                 {stop.fd(), POLLIN, 0},
                                 {node_.wake_fd(), POLLIN, 0},
                                 {joystick_.fd(), POLLIN, 0}}};
      const auto left = std::chrono::ceil<milliseconds>(due - Clock::now());
      poll(fds.data(), fds.size(), static_cast<int>(std::max<long>(0, left.count())));
      if ((fds[0].revents & (POLLHUP | POLLERR)) != 0)
        break;  // the terminal is gone
      if ((fds[0].revents & POLLIN) != 0 && !read_keys())
        break;
      if (fds[3].revents != 0)
        take_stick();
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

  /// Lets autonomy drive again after a person has driven.
  int hand_back(const bus::Stop& stop) {
    bool waited = false;
    double again = 0.0;
    const auto began = Clock::now();
    while (!stop.requested() && seconds_since(began) < kHandBackLimit) {
      node_.wait(milliseconds(20), &stop);
      take();
      if (!grant_)
        continue;
      if (!grant_->waits_for_hand_back && !grant_->estopped) {
        print("%s\n", waited ? "handed back: autonomy may drive"
                             : ("nothing waits to be handed back: " + describe(*grant_)).c_str());
        return bus::kExitOk;
      }
      waited = true;
      if (const std::string refusal = pilot_.refusal(now()); !refusal.empty()) {
        complain("saphira: not handed back: %s\n", refusal.c_str());
        return bus::kExitFailed;
      }
      if (seconds_since(began) >= again) {
        pilot_.hand_back();
        send();
        again = seconds_since(began) + 0.1;
      }
    }
    complain("saphira: %s\n",
             grant_ ? "the bridge has not confirmed that the robot is handed back"
                    : ("not handed back: no bridge is heard; " + who_is_there(processes_)).c_str());
    return bus::kExitFailed;
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
    for (const DriveKey key : teleop::take_keys(input_))
      press(key);
    return true;
  }

  void take_stick() {
    const bool was = joystick_.stick().order(now()).active;
    joystick_.read(now());
    if (!robot_)
      return joystick_.stick().let_go();  // a person must see the robot to drive it
    const bool is = joystick_.stick().order(now()).active;
    if (!is && note_.empty())
      note_ = joystick_.describe();
    if (is == was)
      return;
    if (is) {
      keys_.release();
      end_constant();
      note_.clear();
    }
    if (!joystick_.there())
      note_ = "the joystick is gone: the robot is released";
    send();  // at once: a stop does not wait for the period
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
      case DriveKey::hand_back:
        keys_.release();
        pilot_.hand_back();
        note_ = "handed back: autonomy may drive";
        return;
      case DriveKey::stop:
        return stop_all();
      default:
        break;
    }
    note_.clear();
    if (!robot_)
      return;  // a person must see the robot to drive it
    end_constant();
    keys_.press(key, now());
    send();  // at once: a stop does not wait for the period
  }

  /// k: ends whatever moves the robot. A held key repeats.
  void stop_all() {
    keys_.release();
    joystick_.stick().let_go();
    end_constant();
    send();
    if (now() - stopped_at_ < kStopAgain)
      return;
    stopped_at_ = now();
    stops_.send(bus::request("stop"), [this](const v1::Answer& answer) {
      note_ = (answer.service.empty() ? "NOT CONFIRMED: " : "") + answer.text;
    });
    note_ = "NOT CONFIRMED: asks the bridge to stop whatever moves the robot";
  }

  /// g: the goal drive, so that the behaviors keep the speed and avoid obstacles.
  void toggle_constant() {
    if (constant_) {
      end_constant();
      note_ = "constant velocity off";
      return;
    }
    keys_.release();
    v1::Goal goal{.functor = "drive", .arguments = {bus::number("speed", kConstantVelocity)}};
    constant_ = goals_.ask(goal);
    pilot_.hand_back();
    note_ = "constant velocity on: the behaviors drive around obstacles";
  }

  void end_constant() {
    if (constant_)
      goals_.cancel(*constant_);
    constant_.reset();
  }

  void take() {
    processes_.poll();
    goals_.poll();
    stops_.poll(now());
    if (robot_.poll())
      robot_came_ = Clock::now();
    if (description_.poll()) {
      keys_.set_max_velocity(description_->max_velocity);
      joystick_.stick().set_max_velocity(description_->max_velocity);
    }
    if (!joystick_.there() && seconds_since(looked_) > 1.0) {
      joystick_.open();
      looked_ = Clock::now();
      if (joystick_.there())
        note_ = joystick_.describe();
    }
    if (grant_.poll())
      pilot_.heard(*grant_, now());
    if (constant_)
      if (const auto status = goals_.status(*constant_)) {
        if (bus::ended(status->state)) {
          note_ = "constant velocity " + bus::describe(*status);
          constant_.reset();
        }
      }
  }

  /// The keys' stop is stronger than a held stick.
  Order wanted() {
    Order order = keys_.order(now());
    // Unique over restarts of this program too, or the bridge would take the first for an old one.
    if (order.turn)
      order.turn->move += node_.instance();
    if (const Order stick = joystick_.stick().order(now()); stick.active && !order.active)
      order = stick;
    if (robot_)
      order.cycle = robot_->stamp.cycle;
    return order;
  }

  bool send() {
    const auto command = pilot_.drive(wanted(), robot_ ? robot_->stamp : v1::Stamp());
    if (command)
      commands_.write(*command);
    return command.has_value();
  }

  void show() {
    Order setpoint = wanted();
    const bool refused = !pilot_.refusal(now()).empty();
    if (refused)
      setpoint.velocity = 0.0;  // a refused setpoint is not shown as wanted
    std::string line;
    if (!robot_ || seconds_since(robot_came_) > 1.0) {
      line = "no robot: " + who_is_there(processes_);
    } else {
      line =
          format("want %+.2f m/s  is %+.2f m/s %+4.0f deg/s  at (%.2f, %.2f) %4.0f deg  %.1f V%s%s",
                 setpoint.velocity, robot_->velocity, degrees(robot_->rotation_velocity),
                 robot_->pose_in_odom.x, robot_->pose_in_odom.y, degrees(robot_->pose_in_odom.th),
                 robot_->battery, robot_->left_stalled ? "  LEFT STALLED" : "",
                 robot_->right_stalled ? "  RIGHT STALLED" : "");
    }
    const bool still = setpoint.velocity == 0.0 && setpoint.rotation == 0.0 &&
                       (!setpoint.turn || setpoint.turn->by == 0.0);
    std::string second = !setpoint.active ? "released"
                         : refused        ? "NOT driving"
                         : still          ? "holding still"
                         : setpoint.turn  ? "driving"
                                          : "driving by joystick";
    if (joystick_.stick().is_silent(now()))
      note_ = "the joystick is held and says nothing: move it, or press its button again";
    if (grant_)
      second += "  |  " + describe(*grant_);
    const std::string refusal = pilot_.refusal(now(), kTellRefusal);
    const std::string third = refusal.empty() ? note_ : "refused: " + refusal;
    // Four lines, each cut to the terminal, so that the cursor can go back up over them.
    winsize size{};
    const std::size_t width =
        ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1U : 79U;
    const auto [begin, rest] = two_lines(second, width);
    std::string picture = "\x1b[3F";
    bool first = true;
    for (const std::string* each :
         std::initializer_list<const std::string*>{&line, &begin, &rest, &third}) {
      picture += first ? "\r\x1b[K" : "\n\x1b[K";
      first = false;
      picture += each->substr(0, width);
    }
    out().show(picture);
  }

  /// Releases the robot, which stops it, without a hand-back.
  void finish() {
    keys_.release();
    joystick_.stick().lost();
    for (int i = 0; i < teleop::kReleases && send(); ++i)
      node_.wait(milliseconds(20));
    take();
    out().flush(milliseconds(100));  // the last picture comes before it
    if (grant_ && grant_->waits_for_hand_back)
      print("\n%s\n", latched(*grant_).c_str());
    if (constant_) {
      end_constant();
      goals_.delivered(500);
    }
  }

  Joystick joystick_;
  Clock::time_point looked_;  ///< time of the last search for a joystick
  bus::Node node_;
  Processes processes_;
  bus::GoalClient goals_;
  bus::RequestClient stops_{node_, bus::topics::kDriveStop, person("keyboard")};
  bus::Writer<v1::MotorCommand> commands_ = node_.writer(bus::topics::kDriveTeleop);
  Newest<v1::RobotState> robot_{node_, bus::topics::kRobotState};
  Newest<v1::RobotDescription> description_{node_, bus::topics::kRobotDescription};
  Newest<v1::Grant> grant_{node_, bus::topics::kGrant};

  KeyDrive keys_;
  std::string input_;
  teleop::Pilot pilot_{person("keyboard", true)};
  bool quit_ = false;
  double stopped_at_ = -1e9;  ///< [s]
  std::optional<v1::GoalId> constant_;
  Clock::time_point robot_came_;
  std::string note_ = joystick_.describe();
};

int drive(const std::string& joystick, const bus::NodeOptions& options, const bus::Stop& stop) {
  if (joystick != kJoystick && access(joystick.c_str(), R_OK) != 0)
    throw std::invalid_argument(cannot_be(joystick, "read"));
  if (isatty(STDIN_FILENO) == 0)
    throw std::invalid_argument("drive needs a terminal for its keys");
  return Teleop(options, joystick).run(stop);
}

}  // namespace

void add_drive(CLI::App& app, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("drive", "Drive by keyboard or joystick, while something is held");
  auto joystick = std::make_shared<std::string>(kJoystick);
  command->add_option("--joystick", *joystick, "The kernel's device of a joystick or gamepad")
      ->capture_default_str();
  CLI::App* back = command->add_subcommand(
      "hand-back", "After a person has driven: lets goals and behaviors drive again");
  command->require_subcommand(0, 1);
  command->footer(std::string("Keys:\n") + kKeys);
  command->callback([back, joystick, &chosen] {
    chosen.run = [joystick](const bus::NodeOptions& options, const bus::Stop& stop) {
      return drive(*joystick, options, stop);
    };
    if (back->parsed())
      chosen.run = [](const bus::NodeOptions& options, const bus::Stop& stop) {
        return Teleop(options).hand_back(stop);
      };
  });
}

}  // namespace saphira::cli
