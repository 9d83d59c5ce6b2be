#include "saphira/sim/host.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <utility>

#include "feeds.hpp"
#include "pace.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/full_disk.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/text.hpp"
#include "saphira/sim/resume.hpp"
#include "saphira/sim/simulation.hpp"
#include "saphira/sim/view.hpp"
#include "station.hpp"
#include "world_check.hpp"

namespace saphira::sim {

namespace {

using Clock = std::chrono::steady_clock;

// Silence after which a packet that has begun will not be completed.
constexpr double kGap = 0.050;  // [s]

// While time is paused a client hears this often that the simulator is there.
constexpr std::chrono::milliseconds kTells{500};

// Steps that wait for a client.
constexpr int kMostSteps = 100;

// Between two checks for a client at a terminal.
constexpr int kPollPeriod = 50;  // [ms]

class Serving : ViewedHost {
 public:
  /// `view`, which may be null, outlives it.
  Serving(const HostOptions& options, Simulation& simulation, ViewFeed* view)
      : simulation_(simulation),
        view_(view),
        unpaced_(options.rate == kMaxRate),
        pacing_{false, unpaced_ ? 1.0 : options.rate},
        pace_(options.rate) {
    for (RobotNumber i = 0; i < simulation.size(); ++i)
      stations_.push_back(std::make_unique<Station>(options, simulation, i));
    if (view_ == nullptr)
      return;
    choice_ = [worlds = options.worlds, robots = options.robots,
               world = std::filesystem::path(options.world).stem().string()] {
      using Names = std::vector<std::string>;
      return Choice{worlds ? worlds() : Names(), robots ? robots() : Names(), world};
    };
    view_->tell(describe_world(simulation.scene().world(), choice_()), true);
  }

  bool serve(int stop_fd, int most_ms) {
    int timeout = schedule();
    const auto at_most = [&](int limit) {
      timeout = timeout < 0 ? limit : std::min(timeout, limit);
    };
    for (const auto& station : stations_) {
      station->look_at_terminal();
      if (station->waits_for_terminal())
        at_most(kPollPeriod);
    }
    if (most_ms >= 0)
      at_most(most_ms);
    // In that order: stop, timer, then each robot's client and listener, then viewers.
    fds_.clear();
    fds_.push_back({stop_fd, POLLIN, 0});
    fds_.push_back({timer_.fd(), POLLIN, 0});
    for (const auto& station : stations_)
      station->add_to(fds_);
    for (const auto& station : stations_)
      station->add_viewers_to(fds_);
    if (view_ != nullptr)
      view_->add_to(fds_);
    if (::poll(fds_.data(), fds_.size(), timeout) < 0) {
      if (errno == EINTR)
        return true;
      fail("poll");
    }
    if (fds_[0].revents != 0)
      return false;
    step(fds_);
    take_steps();
    if (view_ != nullptr)
      serve_view();
    return true;
  }

  /// A world or robots requested at the view.
  std::optional<Load> take_load() { return std::exchange(load_, std::nullopt); }

  void end() {
    for (const auto& station : stations_)
      station->end();
  }

 private:
  static bool client_ready(const std::vector<pollfd>& fds, std::size_t station) {
    return fds[2 + 2 * station].revents != 0;
  }
  static bool listener_ready(const std::vector<pollfd>& fds, std::size_t station) {
    return fds[3 + 2 * station].revents != 0;
  }

  // Sets the timer to the next information packet, or to the end of a silence. Returns poll's
  // timeout [ms], without end below zero.
  int schedule() {
    const bool ran = running_;
    running_ = simulation_.runs() && !pacing_.paused;
    if (running_ && unpaced_)
      return patience();
    if (running_) {
      if (!ran)
        pace_.restart();
      timer_.set(pace_.seconds_until(simulation_.ticks_to_packet()));
      timed_ = true;
      return -1;
    }
    const bool pending = std::ranges::any_of(
        stations_, [](const auto& station) { return station->packet_pending(); });
    const bool tells = pacing_.paused && simulation_.runs();
    if (pending || tells) {
      const double rest = std::chrono::duration<double>(tells_at_ - Clock::now()).count();
      timer_.set(pending ? kGap : std::max(rest, 1e-3));
      timed_ = true;
    } else if (timed_) {
      timer_.clear();
      timed_ = false;
    }
    return -1;
  }

  // Free running: the wait for clients [ms].
  int patience() {
    double wait = 0.0;
    waits_ = false;
    for (const auto& station : stations_) {
      if (station->sending())
        waits_ = true;
      else if (station->is_behind())
        wait = std::max(wait, station->seconds_until_given_up());
    }
    if (waits_)
      return -1;
    waits_ = wait > 0.0;
    return waits_ ? 1 + static_cast<int>(wait * 1000.0) : 0;
  }

  void step(const std::vector<pollfd>& fds) {
    const bool timer_ready = fds[1].revents != 0;
    if (timer_ready) {
      std::uint64_t count = 0;
      [[maybe_unused]] const auto size = ::read(timer_.fd(), &count, sizeof count);
    }
    // Time first, so that new bytes act now, not at the time of the packet before.
    if (running_ && !unpaced_)
      simulation_.advance(pace_.due());
    for (std::size_t i = 0; i < stations_.size(); ++i) {
      if (client_ready(fds, i))
        stations_[i]->read_client();
      else if (timer_ready && !running_)
        stations_[i]->gap();
    }
    if (running_ && unpaced_ && !waits_) {
      simulation_.advance(kTicksPerPacket);
      for (const auto& station : stations_)
        station->count_cycle();
    }
    // A client that hears nothing would end the connection.
    if (pacing_.paused && Clock::now() >= tells_at_) {
      tells_at_ = Clock::now() + kTells;
      for (const auto& station : stations_)
        station->tell_status();
    }
    for (const auto& station : stations_)
      station->write(running_);
    for (std::size_t i = 0; i < stations_.size(); ++i)
      if (listener_ready(fds, i))
        stations_[i]->accept();
  }

  /// Without a client time does not pass, so a step waits for one, such as a bridge that has found
  /// the paused robot silent and connects again.
  void take_steps() {
    for (; steps_ > 0 && simulation_.runs(); --steps_) {
      simulation_.advance(kTicksPerPacket);
      for (const auto& station : stations_)
        station->write(true);
    }
  }

  void serve_view() {
    const bool asked =
        view_->serve([this] { return describe_world(simulation_.scene().world(), choice_()); },
                     [this](const std::string& text) { return obey(text); });
    const std::uint64_t ticks = simulation_.scene().ticks();
    if (!view_->watched() || (!asked && shown_ && ticks < *shown_ + kTicksPerPacket))
      return;
    shown_ = ticks;
    view_->tell(describe_scene(simulation_, pacing_), false);
  }

  /// Carries out a line from the view; returns the answer, as a line.
  std::string obey(const std::string& text) {
    try {
      const std::string trouble = sim::obey(text, simulation_, *this);
      return trouble.empty() ? std::exchange(answer_, {}) : complaint(trouble);
    } catch (const std::invalid_argument& error) {
      return complaint(error.what());
    }
  }
  std::string pause(bool on) override {
    pacing_.paused = on;
    steps_ = 0;
    return {};
  }
  std::string step_once() override {
    if (!pacing_.paused)
      return "time is not paused";
    steps_ = std::min(steps_ + 1, kMostSteps);
    take_steps();
    return {};
  }
  std::string set_rate(double rate) override {
    if (unpaced_)
      return "the simulator runs as fast as it can";
    pacing_.rate = rate;
    pace_ = Pace(rate);
    return {};
  }
  std::string disconnect(RobotNumber robot) override {
    stations_[robot]->drop();
    return {};
  }
  std::string load(Load wish) override {
    load_ = std::move(wish);
    return {};
  }
  std::string list_files() override {
    answer_ = describe_files(choice_());
    return {};
  }

  Simulation& simulation_;
  ViewFeed* view_;
  std::function<Choice()> choice_;      // of files, at present
  std::optional<std::uint64_t> shown_;  // [ticks] time of the newest view
  std::optional<Load> load_;
  std::string answer_;  // to a line from the view
  bool unpaced_;
  Pacing pacing_;
  Pace pace_;
  Timer timer_;
  std::vector<std::unique_ptr<Station>> stations_;
  std::vector<pollfd> fds_;
  int steps_ = 0;  // asked for, while time is paused
  Clock::time_point tells_at_;
  bool running_ = false;
  bool waits_ = false;  // for a client to read its output
  bool timed_ = false;
};

}  // namespace

void offer_files(HostOptions& options, const std::string& config) {
  namespace fs = std::filesystem;
  // By name: a folder's files; the earlier folders first.
  const auto found = [](const std::vector<std::string>& folders, const std::string& extension) {
    std::map<std::string, std::string> files;
    std::error_code none;
    for (const std::string& folder : folders)
      for (const auto& entry : fs::directory_iterator(folder, none))
        if (entry.path().extension() == extension)
          files.emplace(entry.path().stem(), entry.path());
    return files;
  };
  const auto names = [](const std::map<std::string, std::string>& files) {
    std::vector<std::string> all;
    for (const auto& [name, file] : files)
      all.push_back(name);
    return all;
  };
  // Anew at each request: a person may have written a file meanwhile.
  const auto finder = [found](const std::vector<std::string>& folders,
                              const std::string& extension) {
    return [=](const std::string& name) {
      const auto files = found(folders, extension);
      const auto file = files.find(name);
      if (file != files.end())
        return file->second;
      std::string expected;
      for (const auto& [each, path] : files)
        expected += (expected.empty() ? "" : ", ") + each;
      throw std::runtime_error("there is no file \"" + name + extension + "\": expected one of " +
                               expected);
    };
  };
  const std::vector<std::string> worlds{folder_of(options.world), config + "/worlds"};
  const std::vector<std::string> robots{folder_of(options.robot), config + "/robots"};
  options.worlds = [=] { return names(found(worlds, ".wld")); };
  options.robots = [=] { return names(found(robots, ".p")); };
  options.world_file = finder(worlds, ".wld");
  options.robot_file = finder(robots, ".p");
}

std::string default_socket() {
  if (const char* path = std::getenv("ROBOT_SOCKET"); path != nullptr && *path != '\0')
    return path;
  return "/tmp/saphira-robot-" + std::to_string(::getuid());
}

std::string default_terminal() {
  return "/tmp/saphira-robot-" + std::to_string(::getuid()) + ".tty";
}

std::string numbered(const std::string& path, std::size_t number) {
  if (number <= 1)
    return path;
  const std::size_t dot = path.find_last_of("./");
  const std::string text = "-" + std::to_string(number);
  // A name that begins with a dot has no ending.
  if (dot == std::string::npos || path[dot] == '/' || dot == 0 || path[dot - 1] == '/')
    return path + text;
  return path.substr(0, dot) + text + path.substr(dot);
}

struct Host::Parts {
  /// The world with its robots, which nobody serves yet.
  explicit Parts(const HostOptions& options) : world(load_world(options.world, options.things)) {
    add_robots(options);
  }
  Parts(const HostOptions& options, ViewFeed* view) : Parts(options) {
    serving.emplace(options, simulation, view);
  }
  void add_robots(const HostOptions& options);

  World world;
  Simulation simulation{world};
  std::optional<Serving> serving;
};

void Host::Parts::add_robots(const HostOptions& options) {
  const auto warn = [&](const std::vector<std::string>& warnings) {
    if (options.log)
      for (const std::string& warning : warnings)
        options.log("warning", warning);
  };
  warn(world.warnings);
  if (!((options.rate > 0.0 && options.rate <= 1000.0) || options.rate == kMaxRate))
    throw std::invalid_argument(
        "rate: expected more than 0 and at most 1000 times real time, or \"max\"");
  const auto add = [&](const std::string& file, const std::optional<Pose>& start,
                       const std::optional<Place>& place, std::size_t number) {
    const protocol::RobotParameters parameters = protocol::load_parameters(file);
    warn(parameters.warnings);
    if (!start)
      throw std::invalid_argument(options.world + ": expected a directive " +
                                  (number == 0 ? "position" : "robot for each further robot") +
                                  ", or a position among the options");
    ServerOptions server_options;
    server_options.seed = options.seed + number;
    server_options.single_step = options.step;
    server_options.trace = !options.trace.empty();
    try {
      if (const auto trouble = trouble_of_start(world, *start); trouble && !place)
        throw std::invalid_argument(*trouble);
      simulation.add(parameters, *start, server_options);
    } catch (const std::invalid_argument& error) {
      if (place)
        throw FileError(options.world, place->line, place->column, error.what());
      throw std::invalid_argument("--position of robot " + std::to_string(number + 1) + ": " +
                                  error.what());
    }
  };
  if (options.position)
    add(options.robot, options.position, std::nullopt, 0);
  else
    add(options.robot, world.start, world.start_place, 0);
  for (std::size_t i = 0; i < options.more.size(); ++i) {
    const RobotOptions& robot = options.more[i];
    std::optional<Pose> start = robot.position;
    std::optional<Place> place;
    if (!start && i < world.movable.robots.size()) {
      start = world.movable.robots[i];
      place = world.robot_places[i];
    }
    add(robot.robot.empty() ? options.robot : robot.robot, start, place, i + 1);
  }
}

namespace {

std::string world_of(const HostOptions& options) {
  return options.world + "+" + options.things + "+" + options.robot;
}

}  // namespace

Host::Host(const HostOptions& options) : options_(options) {
  if (options_.view_socket)
    view_ = std::make_unique<ViewFeed>(*options_.view_socket);
  parts_ = std::make_unique<Parts>(options_, view_.get());
  take_state();
}
Host::~Host() = default;

bool Host::serve(int stop_fd, int most_ms) {
  if (!parts_->serving->serve(stop_fd, most_ms))
    return false;
  if (const auto load = parts_->serving->take_load())
    change(load->world, load->robot);
  return true;
}

void Host::change(const std::string& world, const std::string& robot) {
  HostOptions next = options_;
  if (!options_.world_file || !options_.robot_file)
    return view_->tell(complaint("nothing else can be loaded into this simulator"), true);
  try {
    if (!world.empty()) {
      next.world = options_.world_file(world);
      next.things.clear();
      next.position.reset();
    }
    if (!robot.empty())
      next.robot = options_.robot_file(robot);
    load_world(next.world, next.things);
    protocol::load_parameters(next.robot);
  } catch (const std::exception& error) {
    return view_->tell(complaint(error.what()), true);
  }
  parts_->serving->end();
  parts_.reset();  // its sockets are needed
  try {
    parts_ = std::make_unique<Parts>(next, view_.get());
    options_ = next;
  } catch (const std::exception& error) {
    parts_ = std::make_unique<Parts>(options_, view_.get());
    view_->tell(complaint(error.what()), true);
  }
}

void Host::end() {
  parts_->serving->end();
  if (options_.state.empty())
    return;
  const std::string text = places_text(parts_->simulation.scene(), world_of(options_));
  if (!replace_file(options_.state, sealed(text)) && options_.log)
    options_.log("error", cannot_be(options_.state, "written"));
}

void Host::take_state() {
  const std::string& file = options_.state;
  if (file.empty())
    return;
  const std::string damaged = read_or_set_aside(file, [&](const std::string& content) {
    const std::string without_place =
        resume(parts_->simulation.scene(), unsealed(content, file), world_of(options_));
    if (!without_place.empty() && options_.log)
      options_.log("warning", file + ": these begin at their start: " + without_place);
  });
  if (!damaged.empty() && options_.log)
    options_.log("warning", damaged);
  // It is of one end: a simulator that is killed begins anew.
  std::error_code none;
  std::filesystem::remove(file, none);
}

void check(const HostOptions& options) {
  const Host::Parts parts(options);
  if (!options.terminal && !options.tcp)
    for (std::size_t number = 1; number <= 1 + options.more.size(); ++number)
      expect_socket(numbered(options.socket.value_or(default_socket()), number));
  for (const auto& socket : {options.view_socket, options.stereo_socket, options.camera_socket})
    if (socket)
      expect_socket(*socket);
}

void run(const HostOptions& options, int stop_fd) {
  Host host(options);
  while (host.serve(stop_fd)) {
  }
  host.end();
}

}  // namespace saphira::sim
