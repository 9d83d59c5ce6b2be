#include "view_feed.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>

namespace saphira::sim {
namespace {

constexpr std::size_t kMostViewers = 16;
constexpr std::size_t kLongest = 4096;         // of an incoming line
constexpr std::size_t kMostWaiting = 1 << 20;  // [bytes] that a viewer has not read

}  // namespace

void ViewFeed::add_to(std::vector<pollfd>& fds) const {
  fds.push_back({listener_.fd(), POLLIN, 0});
  for (const Viewer& viewer : viewers_)
    fds.push_back({viewer.fd.get(),
                   static_cast<short>(viewer.waiting.empty() ? POLLIN : POLLIN | POLLOUT), 0});
}

bool ViewFeed::receive(Viewer& viewer) {
  std::array<char, 2048> part{};
  for (;;) {
    const ssize_t size = ::recv(viewer.fd.get(), part.data(), part.size(), MSG_DONTWAIT);
    if (size == 0 || viewer.said.size() > kLongest)
      return false;
    if (size < 0)
      return errno == EAGAIN || errno == EINTR;
    viewer.said.append(part.data(), static_cast<std::size_t>(size));
  }
}

bool ViewFeed::send(Viewer& viewer) {
  while (!viewer.waiting.empty()) {
    const ssize_t size = ::send(viewer.fd.get(), viewer.waiting.data(), viewer.waiting.size(),
                                MSG_NOSIGNAL | MSG_DONTWAIT);
    if (size < 0)
      return (errno == EAGAIN || errno == EINTR) && viewer.waiting.size() < kMostWaiting;
    viewer.waiting.erase(0, static_cast<std::size_t>(size));
  }
  return true;
}

bool ViewFeed::serve(const std::function<std::string()>& world,
                     const std::function<std::string(const std::string&)>& obey) {
  bool any = false;
  for (Fd fd = listener_.accept(); fd && viewers_.size() < kMostViewers; fd = listener_.accept()) {
    viewers_.push_back({std::move(fd), {}, world()});
    any = true;
  }
  std::erase_if(viewers_, [&](Viewer& viewer) {
    const bool there = receive(viewer);
    for (std::size_t end = viewer.said.find('\n'); end != std::string::npos;
         end = viewer.said.find('\n')) {
      viewer.waiting += obey(viewer.said.substr(0, end));
      viewer.said.erase(0, end + 1);
      any = true;
    }
    return !there || !send(viewer);
  });
  return any;
}

void ViewFeed::tell(const std::string& line, bool must) {
  for (Viewer& viewer : viewers_)
    if (must || viewer.waiting.empty()) {
      viewer.waiting += line;
      send(viewer);
    }
}

}  // namespace saphira::sim
