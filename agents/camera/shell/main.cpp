// saphira-camera: the pictures of a camera beside the robot, for whoever looks. README.md.
#include <poll.h>

#include <array>
#include <chrono>
#include <exception>

#include "saphira/bus/program.hpp"
#include "source.hpp"

namespace {

using namespace saphira;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr Seconds kRetry{0.5};
constexpr int kTurn = 250;  // [ms]

struct Options {
  std::string socket;
  std::string device = "/dev/video0";
  std::string name = "front";
  int columns = 320;
  int rows = 240;
  int quality = 60;
  double rate = 10.0;
  double field_of_view = 0.0;  // [degrees]
  double height = 0.0;
  double forward = 0.0;
};

class Program {
 public:
  Program(bus::Node& node, const Options& options) : node_(node), options_(options) {}

  int run(const bus::Stop& stop) {
    node_.status().state = v1::SERVICE_RUNNING;
    while (!stop.requested()) {
      open_or_close();
      std::array<pollfd, 3> fds{{{node_.wake_fd(), POLLIN, 0},
                                 {stop.fd(), POLLIN, 0},
                                 {source_ ? source_->fd() : -1, POLLIN, 0}}};
      ::poll(fds.data(), fds.size(), kTurn);
      node_.clear_wake();
      if (states_)
        if (const auto state = states_->take_newest()) {
          stamp_ = state->stamp;
          head_ = state->head;
          stamped_ = Clock::now();
        }
      if (source_ && fds[2].revents != 0)
        pass_on();
      node_.publish_status();
    }
    return bus::kExitOk;
  }

 private:
  /// The camera is off while nobody reads.
  void open_or_close() {
    if (pictures_.matched() == 0) {
      source_.reset();
      states_.reset();
      return say("off: nobody looks");
    }
    if (!states_)
      states_.emplace(node_.reader(bus::topics::kRobotState));
    if (source_ || Clock::now() < next_try_)
      return;
    next_try_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(kRetry);
    try {
      source_ = options_.socket.empty()
                    ? camera::open_device(options_.device, options_.columns, options_.rows)
                    : camera::open_socket(options_.socket);
      say("");
    } catch (const std::exception& error) {
      say(error.what());
    }
  }

  void pass_on() {
    try {
      const auto frame = source_->read();
      const auto now = Clock::now();
      if (!frame || Seconds(now - written_).count() < kEarly / options_.rate)
        return;
      written_ = now;
      const bool is_simulated = frame->cycle != 0;
      v1::CameraPicture picture{
          .stamp = {.epoch = stamp_.epoch, .cycle = is_simulated ? frame->cycle : stamp_.cycle},
          .delay = is_simulated || stamp_.cycle == 0 ? 0.0 : Seconds(now - stamped_).count(),
          .number = ++number_,
          .camera = options_.name,
          .columns = static_cast<std::uint16_t>(frame->columns),
          .rows = static_cast<std::uint16_t>(frame->rows),
          .field_of_view = is_simulated ? frame->field_of_view : radians(options_.field_of_view),
          .pose_in_robot = {.x = is_simulated ? frame->pose_in_robot.x : options_.forward,
                            .y = 0.0,
                            .th = is_simulated ? frame->pose_in_robot.th : head_},
          .height = is_simulated ? frame->height : options_.height,
          .jpeg = camera::to_jpeg(*frame, options_.quality)};
      pictures_.write(picture);
    } catch (const std::exception& error) {
      source_.reset();
      say(error.what());
    }
  }

  void say(const std::string& reason) {
    if (node_.status().reason == reason)
      return;
    node_.status().reason = reason;
    if (!reason.empty())
      node_.info(reason);
  }

  static constexpr double kEarly = 0.8;  // of a period: frames do not come evenly

  bus::Node& node_;
  const Options& options_;
  bus::Writer<v1::CameraPicture> pictures_ = node_.writer(bus::topics::kCameraPictures);
  std::optional<bus::Reader<v1::RobotState>> states_;
  std::unique_ptr<camera::Source> source_;
  Clock::time_point next_try_;
  Clock::time_point written_;
  Clock::time_point stamped_;
  v1::Stamp stamp_;
  double head_ = 0.0;  // [rad] as of the stamp
  std::uint64_t number_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return bus::run_program(
      argc, argv, "camera", "Sends the pictures of a camera beside the robot to whoever looks.",
      [&](CommandLine& app) {
        app.add_option("--socket", options.socket, "the simulator's pictures: its --camera-socket");
        app.add_option("--device", options.device, "a camera of this machine");
        app.add_option("--camera", options.name, "its name, for people");
        app.add_option("--columns", options.columns, "[pixels] of a picture").in_range(16, 4096);
        app.add_option("--rows", options.rows, "[pixels]").in_range(16, 4096);
        app.add_option("--quality", options.quality, "of the JPEG: 1 to 100").in_range(1, 100);
        app.add_option("--rate", options.rate, "[1/s] at most").in_range(0.1, 30.0);
        app.add_option("--field-of-view", options.field_of_view,
                       "[degrees] from side to side; the page draws what the sonars hear by it")
            .in_range(0.0, 170.0);
        app.add_option("--lens-height", options.height, "[m] above the floor").in_range(0.0, 3.0);
        app.add_option("--lens-forward", options.forward, "[m] before the robot's centre")
            .in_range(-2.0, 2.0);
      },
      [&](const bus::NodeOptions& node_options, const bus::Stop& stop) {
        bus::Node node(node_options);
        return Program(node, options).run(stop);
      });
}
