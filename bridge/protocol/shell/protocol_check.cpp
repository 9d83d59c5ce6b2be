// saphira-protocol-check: relays between a client and a robot server and reports deviations from
// the tables. It changes nothing.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <iostream>
#include <stdexcept>

#include "saphira/base/descriptor.hpp"
#include "saphira/base/places.hpp"
#include "saphira/base/stop_signals.hpp"
#include "saphira/command_line/command_line.hpp"
#include "saphira/protocol/check.hpp"
#include "saphira/transport/address.hpp"
#include "saphira/transport/link.hpp"

namespace {

using namespace saphira;
using protocol::Bytes;
using protocol::Side;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

template <class Address>
int listen_on(int family, const Address& address, const std::string& name) {
  const int fd = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (fd < 0 || ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(fd, 4) != 0)
    fail(name);
  return fd;
}

int listen_at(const transport::Address& address) {
  if (address.kind == transport::Address::Kind::local) {
    sockaddr_un local{};
    local.sun_family = AF_UNIX;
    if (address.name.size() >= sizeof local.sun_path)
      throw std::invalid_argument(address.name + ": the path of a socket is shorter");
    std::memcpy(local.sun_path, address.name.c_str(), address.name.size() + 1);
    ::unlink(address.name.c_str());
    return listen_on(AF_UNIX, local, address.name);
  }
  if (address.kind == transport::Address::Kind::tcp) {
    sockaddr_in inet{};
    inet.sin_family = AF_INET;
    inet.sin_port = htons(static_cast<std::uint16_t>(address.port));
    if (::inet_pton(AF_INET, address.name.c_str(), &inet.sin_addr) != 1)
      throw std::runtime_error(address.name + ": expected a numeric address, such as 127.0.0.1");
    return listen_on(AF_INET, inet, address.text());
  }
  throw std::runtime_error(address.text() + ": expected a local socket or tcp:HOST:PORT");
}

bool write_all(int fd, const Bytes& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t size = ::send(fd, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (size < 0 && errno == EINTR)
      continue;
    if (size <= 0)
      return false;
    done += static_cast<std::size_t>(size);
  }
  return true;
}

// One conversation after the other; each client gets a connection of its own to the server.
class Proxy {
 public:
  Proxy(const transport::Address& listen, transport::Address server, const std::string& robots)
      : server_(std::move(server)),
        listener_(listen_at(listen)),
        checker_([robots](const protocol::RobotIdentity& identity)
                     -> std::optional<protocol::RobotParameters> {
          const auto path =
              protocol::find_parameter_file(robots, identity.robot_class, identity.subclass);
          return path ? std::optional(protocol::load_parameters(*path)) : std::nullopt;
        }) {}

  void run(int stop_fd) {
    while (true) {
      std::array<pollfd, 2> fds{{{stop_fd, POLLIN, 0}, {listener_, POLLIN, 0}}};
      if (::poll(fds.data(), fds.size(), -1) < 0 && errno != EINTR)
        fail("poll");
      if (fds[0].revents != 0)
        return;
      if (fds[1].revents == 0)
        continue;
      const Descriptor client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      if (client < 0)
        continue;
      const bool stopped = converse(client, stop_fd);
      checker_.disconnect();
      report();
      if (stopped)
        return;
    }
  }

  const protocol::Checker& checker() const { return checker_; }

 private:
  // True where it was stopped.
  bool converse(int client, int stop_fd) {
    const int yes = 1;  // fails on a local socket, where it is not needed
    ::setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    transport::Link link(server_);
    link.advance(now());
    while (link.state() != transport::Link::State::closed) {
      std::array<pollfd, 3> fds{
          {{stop_fd, POLLIN, 0}, {client, POLLIN, 0}, {link.fd(), link.poll_events(), 0}}};
      if (::poll(fds.data(), fds.size(), 1000) < 0 && errno != EINTR)
        fail("poll");
      if (fds[0].revents != 0)
        return true;
      link.advance(now());
      if (link.state() != transport::Link::State::open)
        continue;
      if (fds[1].revents != 0) {
        Bytes bytes(4096);
        const ssize_t size = ::read(client, bytes.data(), bytes.size());
        if (size <= 0)
          return false;
        bytes.resize(static_cast<std::size_t>(size));
        checker_.feed(Side::kClient, bytes, now());
        link.write(bytes, now());
      }
      if (fds[2].revents != 0) {
        Bytes bytes;
        const bool alive = link.read(bytes, now());
        checker_.feed(Side::kServer, bytes, now());
        if (!write_all(client, bytes) || !alive)
          return false;
      }
      report();
    }
    std::cerr << server_.text() << ": " << link.trouble() << '\n';
    return false;
  }

  void report() {
    for (; reported_ < checker_.findings().size(); ++reported_)
      std::cout << to_string(checker_.findings()[reported_]) << std::endl;
  }

  transport::Address server_;
  Descriptor listener_;
  protocol::Checker checker_;
  std::size_t reported_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  CommandLine app{
      "Passes bytes between a client and a robot server, and prints what of them is against the "
      "protocol's tables. Ends by SIGINT or SIGTERM with a summary; code 1: there were violations"};
  std::string listen;
  std::string server;
  std::string robots;
  app.add_option("--listen", listen, "Where the client connects: PATH or tcp:HOST:PORT").required();
  app.add_option("--server", server,
                 "Where the robot server is, as the bridge's --robot-port says it")
      .required();
  app.add_option(
      "--robots", robots,
      "Folder of robot parameter files [the installed ones, or those of the source tree]");
  if (const auto code = app.parse(argc, argv))
    return *code;
  return exit_code_of("saphira-protocol-check", [&] {
    const int stop_fd = stop_on_signals();
    if (robots.empty())
      robots = config_folder() + "/robots";
    Proxy proxy(transport::parse_address(listen), transport::parse_address(server), robots);
    proxy.run(stop_fd);
    std::cout << proxy.checker().summary() << std::flush;
    return proxy.checker().violations() == 0 ? kExitOk : kExitFailed;
  });
}
