#include "saphira/sim/line_check.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <utility>

#include "saphira/base/text.hpp"

namespace saphira::sim {

LineCheck::LineCheck(const std::string& path, std::string prefix,
                     const protocol::RobotParameters& parameters)
    : prefix_(std::move(prefix)),
      file_(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666)),
      checker_([parameters](const protocol::RobotIdentity&) { return parameters; }) {
  if (file_ < 0)
    throw UnusableFile(cannot_be(path, "written"));
}

LineCheck::~LineCheck() {
  ::close(file_);
}

void LineCheck::pass(protocol::Side side, protocol::ByteView bytes, std::optional<double> time) {
  checker_.feed(side, bytes, time);
  report();
}

void LineCheck::disconnect() {
  checker_.disconnect();
  report();
  std::istringstream lines(checker_.summary());
  for (std::string line; std::getline(lines, line);)
    write(line);
}

void LineCheck::report() {
  for (; reported_ < checker_.findings().size(); ++reported_)
    write(to_string(checker_.findings()[reported_]));
}

void LineCheck::write(const std::string& text) const {
  const std::string line = prefix_ + text + "\n";
  [[maybe_unused]] const ssize_t size = ::write(file_, line.data(), line.size());
}

std::string default_check() {
  const char* path = std::getenv("SAPHIRA_CHECK");
  return path != nullptr ? path : "";
}

}  // namespace saphira::sim
