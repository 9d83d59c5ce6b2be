#include "noise.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <stdexcept>
#include <vector>

#include "saphira/base/random.hpp"

namespace saphira::test {

namespace {

sockaddr_un address(const std::string& path) {
  sockaddr_un out{};
  out.sun_family = AF_UNIX;
  path.copy(out.sun_path, sizeof out.sun_path - 1);
  return out;
}

}  // namespace

NoisyLine::NoisyLine(std::string listen_on, std::string connect_to, std::uint64_t seed)
    : path_(std::move(listen_on)),
      target_(std::move(connect_to)),
      seed_(seed),
      listener_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const sockaddr_un name = address(path_);
  if (::bind(listener_, reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0 ||
      ::listen(listener_, 4) != 0)
    throw std::runtime_error(path_ + ": cannot listen");
  thread_ = std::thread([this] { run(); });
}

NoisyLine::~NoisyLine() {
  stop_ = true;
  thread_.join();
  ::close(listener_);
  ::unlink(path_.c_str());
}

void NoisyLine::run() {
  while (!stop_) {
    pollfd ready{listener_, POLLIN, 0};
    if (::poll(&ready, 1, 50) != 1)
      continue;
    const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (client >= 0) {
      serve(client);
      ::close(client);
    }
  }
}

void NoisyLine::serve(int client) {
  const int robot = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_un name = address(target_);
  if (::connect(robot, reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0) {
    ::close(robot);
    return;
  }
  Random random(seed_);
  pollfd ends[2] = {{client, POLLIN, 0}, {robot, POLLIN, 0}};
  bool open = true;
  while (open && !stop_) {
    ::poll(ends, 2, 50);
    for (int i = 0; i < 2; ++i) {
      if (ends[i].revents == 0)
        continue;
      std::uint8_t in[512];
      const ssize_t n = ::read(ends[i].fd, in, sizeof in);
      if (n <= 0) {
        open = false;
        break;
      }
      std::vector<std::uint8_t> out;
      for (ssize_t k = 0; k < n; ++k) {
        if (!random.chance(probability_[i])) {
          out.push_back(in[k]);
          continue;
        }
        ++hurt_;
        switch (random.next() % 3) {
          case 0:
            out.push_back(static_cast<std::uint8_t>(random.next()));
            break;
          case 1:
            break;
          default:
            out.push_back(in[k]);
            out.push_back(in[k]);
        }
      }
      if (::send(ends[1 - i].fd, out.data(), out.size(), MSG_NOSIGNAL) < 0)
        open = false;
    }
  }
  ::close(robot);
}

}  // namespace saphira::test
