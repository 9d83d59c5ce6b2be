#include "saphira/transport/address.hpp"

#include <sys/un.h>
#include <termios.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <stdexcept>

#include "baud.hpp"

namespace saphira::transport {

namespace {

int number(const std::string& text, const std::string& whole, const char* what) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value <= 0)
    throw std::invalid_argument("\"" + whole + "\": expected " + what + ", found \"" + text + "\"");
  return value;
}

}  // namespace

std::string Address::text() const {
  switch (kind) {
    case Kind::serial:
      return name + "@" + std::to_string(baud);
    case Kind::local:
      return "unix:" + name;
    case Kind::tcp:
      return "tcp:" + name + ":" + std::to_string(port);
  }
  return name;
}

Address parse_address(const std::string& text) {
  Address address;
  if (text.starts_with("tcp:")) {
    const std::string rest = text.substr(4);
    const std::size_t colon = rest.rfind(':');
    if (colon == std::string::npos || colon == 0)
      throw std::invalid_argument("\"" + text + "\": expected tcp:host:port");
    address.kind = Address::Kind::tcp;
    address.name = rest.substr(0, colon);
    if (address.name.size() > 2 && address.name.front() == '[' && address.name.back() == ']')
      address.name = address.name.substr(1, address.name.size() - 2);
    address.port = number(rest.substr(colon + 1), text, "a port in 1..65535");
    if (address.port > 65535)
      throw std::invalid_argument("\"" + text + "\": expected a port in 1..65535");
    return address;
  }
  if (text.starts_with("/dev/")) {
    address.kind = Address::Kind::serial;
    const std::size_t at = text.find('@');
    address.name = text.substr(0, at);
    if (at != std::string::npos)
      address.baud = number(text.substr(at + 1), text, "a baud rate");
    if (!speed_of(address.baud))
      throw std::invalid_argument("\"" + text +
                                  "\": expected a baud rate of 1200, 2400, 4800, 9600, 19200, "
                                  "38400, 57600, 115200 or 230400");
    return address;
  }
  address.kind = Address::Kind::local;
  address.name = text.starts_with("unix:") ? text.substr(5) : text;
  if (address.name.empty() || (!text.starts_with("unix:") && text.front() != '/'))
    throw std::invalid_argument(
        "\"" + text +
        "\": expected a robot's address: /dev/tty...[@baud], unix:/path or tcp:host:port");
  if (address.name.size() >= sizeof(sockaddr_un::sun_path))
    throw std::invalid_argument("\"" + text + "\": the path of a local socket has at most " +
                                std::to_string(sizeof(sockaddr_un::sun_path) - 1) + " characters");
  return address;
}

std::string default_address() {
  if (const char* path = std::getenv("ROBOT_SOCKET"); path != nullptr && *path != '\0')
    return path;
  return "unix:/tmp/saphira-robot-" + std::to_string(getuid());
}

}  // namespace saphira::transport
