#include "saphira/base/output.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace saphira {

std::string output_trouble(int fd, int why) {
  pollfd reader{fd, POLLOUT, 0};
  const bool left = ::poll(&reader, 1, 0) == 1 && (reader.revents & (POLLERR | POLLHUP)) != 0;
  return left || why == EPIPE
             ? std::string()
             : "could not write the output: " + std::generic_category().message(why);
}

std::string flush_standard_output() {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)
    return {};
  // An earlier write has not kept its reason; another one has it again.
  if (errno == 0 && ::write(STDOUT_FILENO, "\n", 1) >= 0)
    errno = EIO;
  return output_trouble(STDOUT_FILENO, errno);
}

}  // namespace saphira
