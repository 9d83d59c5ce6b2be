#include "station.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>

namespace saphira::sim {
namespace {

// The lead of a client in single step over a viewer of its stereo pictures.
constexpr std::size_t kPicturesInStep = 4;

// Free running, time may be this far ahead of a client: less than the watchdog's two seconds. A
// client that is silent for kGivenUp by the wall clock is not waited for any more.
constexpr int kMostAhead = 10;    // [cycles]
constexpr double kGivenUp = 2.0;  // [s]

// Bytes that may wait for a client that does not read. Beyond that it loses whole packets, the
// newest: they would be stale when it wakes.
constexpr std::size_t kMost = 65536;

/// `number` of the robot, from 1. Nothing for a terminal.
std::optional<Listener> listen(const HostOptions& options, std::size_t number) {
  if (options.terminal)
    return std::nullopt;
  if (!options.tcp)
    return Listener::local(numbered(options.socket.value_or(default_socket()), number));
  const std::size_t port = *options.tcp == 0 ? 0 : *options.tcp + number - 1;
  if (port > 65535)
    throw std::invalid_argument("port " + std::to_string(port) + ": expected at most 65535");
  return Listener::tcp(options.tcp_address, static_cast<std::uint16_t>(port));
}

std::string default_check() {
  const char* path = std::getenv("SAPHIRA_CHECK");
  return path != nullptr ? path : "";
}

}  // namespace

Station::Station(const HostOptions& options, Simulation& simulation, RobotNumber number)
    : log_(options.log),
      prefix_(options.more.empty() ? "" : "robot " + std::to_string(number + 1) + ": "),
      patient_(options.rate == kMaxRate),
      real_time_(options.rate == 1.0),
      simulation_(simulation),
      number_(number),
      trace_(options.trace.empty() ? "" : numbered(options.trace, number + 1)),
      listener_(listen(options, number + 1)) {
  if (const std::string path = options.check.value_or(default_check()); !path.empty())
    check_.emplace(path, prefix_, server().parameters());
  const auto numbered_socket = [&](const std::optional<std::string>& socket) {
    return socket ? std::optional(numbered(*socket, number + 1)) : std::nullopt;
  };
  if (!options.stereo.empty() || options.stereo_socket)
    pictures_.emplace_back(stereo_pairs(options.seed + number),
                           options.stereo.empty() ? "" : numbered(options.stereo, number + 1),
                           numbered_socket(options.stereo_socket), kPicturesInStep);
  if (options.camera_socket)
    pictures_.emplace_back(color_pictures(), "", numbered_socket(options.camera_socket), 1);
  if (options.terminal)
    terminal_.emplace(numbered(*options.terminal, number + 1));
  log("listening on " + (terminal_ ? terminal_->name() : listener_->name()) +
      (options.step ? ", single-step" : ""));
}

void Station::add_to(std::vector<pollfd>& fds) const {
  const auto events = static_cast<short>(output_.empty() ? POLLIN : POLLIN | POLLOUT);
  fds.push_back({line(), events, 0});  // poll skips those below zero
  fds.push_back({listener_ ? listener_->fd() : -1, POLLIN, 0});
}

bool Station::is_behind() const {
  return server().is_open() && cycles_ >= kMostAhead;
}

double Station::seconds_until_given_up() const {
  return kGivenUp - std::chrono::duration<double>(Clock::now() - heard_).count();
}

void Station::accept() {
  Descriptor fd = listener_->accept();
  if (!fd)
    return;
  if (client_) {
    log("a second client was refused: one at a time");
    return;
  }
  const int yes = 1;  // fails on a local socket, where it is not needed
  ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  // A larger buffer would let time run far ahead of a client.
  const int size = 4096;
  if (patient_)
    ::setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &size, sizeof size);
  client_ = std::move(fd);
  log("a client has connected");
}

void Station::look_at_terminal() {
  if (!terminal_ || terminal_->is_open() == terminal_open_)
    return;
  terminal_open_ = !terminal_open_;
  log(terminal_open_ ? "a client has opened the terminal" : "the client has closed the terminal");
}

void Station::read_client() {
  // The client's earlier bytes were taken before, in order.
  if (line() >= 0)
    send(server().take_output());
  if (line() < 0)
    return;
  std::array<std::uint8_t, 4096> buffer{};
  const ssize_t size = ::read(line(), buffer.data(), buffer.size());
  if (size > 0) {
    cycles_ = 0;
    heard_ = Clock::now();
    const protocol::ByteView bytes(buffer.data(), static_cast<std::size_t>(size));
    watch(protocol::Side::kClient, bytes);
    simulation_.receive(number_, bytes);
  } else if (!terminal_ && (size == 0 || (errno != EAGAIN && errno != EINTR))) {
    hang_up("the client has gone");
  }
}

void Station::write(bool live) {
  const protocol::Bytes fresh = server().take_output();
  if (line() >= 0)
    send(fresh);
  const auto rows = server().take_trace();
  trace_.write(rows);
  // Live, a person may be watching the file.
  if (!rows.empty() && (live || !client_))
    trace_.flush();
  // After the packet, which must not wait for the picture.
  for (PictureFeed& feed : pictures_)
    feed.serve(simulation_.scene(), number_, server().devices().head(), server().cycle(),
               server().single_step());
}

void Station::end() {
  hang_up("stopped");
  trace_.write(server().take_trace());
  trace_.flush();
  const ServerCounters counters = server().counters();
  log("stopped; " + std::to_string(server().robot().contacts()) + " contacts, " +
      std::to_string(counters.bad_packets) + " bad packets, " +
      std::to_string(counters.unknown_commands) + " unknown commands");
}

void Station::watch(protocol::Side side, protocol::ByteView bytes) {
  if (!check_ || bytes.empty())
    return;
  std::optional<double> time;
  if (real_time_ && !server().single_step())
    time = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  check_->pass(side, bytes, time);
}

void Station::send(const protocol::Bytes& fresh) {
  if (output_.size() + fresh.size() <= kMost) {
    watch(protocol::Side::kServer, fresh);
    output_.insert(output_.end(), fresh.begin(), fresh.end());
  }
  while (!output_.empty()) {
    const ssize_t size = terminal_ ? ::write(line(), output_.data(), output_.size())
                                   : ::send(line(), output_.data(), output_.size(), MSG_NOSIGNAL);
    if (size > 0) {
      output_.erase(output_.begin(), output_.begin() + size);
    } else if (errno == EINTR) {
      continue;
    } else {
      if (terminal_)
        lose_output();
      else if (errno != EAGAIN)
        hang_up("the client has gone");
      return;
    }
  }
}

void Station::hang_up(const std::string& why) {
  output_.clear();
  if (!client_)
    return;
  client_.reset();
  simulation_.disconnect(number_);
  if (check_)
    check_->disconnect();
  log(why);
}

}  // namespace saphira::sim
