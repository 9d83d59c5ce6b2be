#include "saphira/base/local_socket.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace saphira {

Descriptor connect_local(const std::string& path, int flags) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    errno = ENAMETOOLONG;
    return {};
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  Descriptor fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | flags, 0);
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return {};
  const std::string folder = path.substr(0, path.rfind('/') + 1);
  struct stat state {};
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::stat(folder.empty() ? "." : folder.c_str(), &state) == 0 &&
      (state.st_mode & S_IWOTH) != 0 &&
      (::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0 ||
       (peer.uid != 0 && peer.uid != ::geteuid()))) {
    errno = EPERM;
    return {};
  }
  return fd;
}

}  // namespace saphira
