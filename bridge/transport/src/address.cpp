#include "saphira/transport/address.hpp"

#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>

#include "baud.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"

namespace saphira::transport {

namespace {

int number(const std::string& text, const std::string& whole, const char* what) {
  const auto value = number_in<int>(text);
  if (!value || *value <= 0)
    throw std::invalid_argument("\"" + whole + "\": expected " + what + ", found \"" + text + "\"");
  return *value;
}

std::string serial_text(const Address& address) {
  std::string out = address.name.starts_with("/dev/") || address.plain_path ? "" : "serial:";
  out.append(address.name).append("@").append(std::to_string(address.baud));
  if (address.parity != 'N' || address.stop_bits != 1)
    out.append(",8").append(1, address.parity).append(std::to_string(address.stop_bits));
  if (address.flow_control)
    out.append(",rtscts");
  return out;
}

void parse_serial(const std::string& text, Address& address) {
  std::string rest = text.substr(text.starts_with("serial:") ? 7 : 0);
  const std::size_t at = rest.find('@');
  address.name = rest.substr(0, at);
  if (address.name.empty())
    throw std::invalid_argument("\"" + text + "\": expected serial:/path[@baud]");
  rest = at == std::string::npos ? "" : rest.substr(at + 1);
  const std::size_t comma = rest.find(',');
  if (at != std::string::npos)
    address.baud = number(rest.substr(0, comma), text, "a baud rate");
  if (!speed_of(address.baud))
    throw std::invalid_argument("\"" + text +
                                "\": expected a baud rate of 1200, 2400, 4800, 9600, 19200, "
                                "38400, 57600, 115200 or 230400");
  rest = comma == std::string::npos ? "" : rest.substr(comma);
  while (!rest.empty()) {
    const std::size_t end = rest.find(',', 1);
    const std::string word = rest.substr(1, end == std::string::npos ? end : end - 1);
    rest = end == std::string::npos ? "" : rest.substr(end);
    if (word == "rtscts") {
      address.flow_control = true;
    } else if (word.size() == 3 && word[0] == '8' &&
               (word[1] == 'N' || word[1] == 'E' || word[1] == 'O') &&
               (word[2] == '1' || word[2] == '2')) {
      address.parity = word[1];
      address.stop_bits = word[2] - '0';
    } else {
      std::string trouble = "\"";
      trouble.append(text).append("\": expected 8N1, 8E1, 8O1, 8N2 or rtscts, found \"");
      throw std::invalid_argument(trouble.append(word).append("\""));
    }
  }
}

void parse_tcp(const std::string& text, Address& address) {
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
}

void parse_ros2(const std::string& text, Address& address) {
  address.kind = Address::Kind::ros2;
  address.name = text;
  const auto end_of = [&](std::size_t from) { return std::min(text.find(',', from), text.size()); };
  std::size_t at = 5;
  if (const std::size_t end = end_of(at); end > at)
    address.arguments.push_back("--namespace=" + text.substr(at, end - at));
  for (at = end_of(at) + 1; at <= text.size(); at = end_of(at) + 1) {
    const std::string word = text.substr(at, end_of(at) - at);
    if (word.find('=') == 0 || word.find('=') == std::string::npos)
      throw std::invalid_argument(
          "\"" + text + "\": expected ros2:NAMESPACE,OPTION=VALUE..., found \"" + word + "\"");
    address.arguments.push_back("--" + word);
  }
}

const char* kind_of_file(const struct stat& about) {
  return S_ISDIR(about.st_mode) ? "a folder" : S_ISREG(about.st_mode) ? "a file" : "a device";
}

/// A path, or nothing that is an address.
void parse_plain(const std::string& text, Address& address) {
  struct stat about {};
  const bool is_there = ::stat(text.c_str(), &about) == 0;
  if (!is_there && text.find('/') == std::string::npos) {
    // host:port is the likeliest mistake.
    const std::size_t colon = text.rfind(':');
    const bool is_host = colon != std::string::npos && colon > 0 && colon + 1 < text.size() &&
                         text.find_first_not_of("0123456789", colon + 1) == std::string::npos;
    throw std::invalid_argument("\"" + text +
                                "\": expected a robot's address: /dev/tty...[@baud], a path, " +
                                "serial:/path[@baud], unix:/path, tcp:host:port or ros2:" +
                                (is_host ? " (did you mean tcp:" + text + "?)" : ""));
  }
  if (is_there && !S_ISCHR(about.st_mode) && !S_ISSOCK(about.st_mode))
    throw std::invalid_argument(
        "\"" + text + "\": expected a serial line or a local socket, found " + kind_of_file(about));
  address.plain_path = true;
  if (!is_there && text.find('@') != std::string::npos) {
    address.plain_path = false;
    address.kind = Address::Kind::serial;
    return parse_serial(text, address);
  }
  address.name = text;
  address.settle();
}

}  // namespace

void Address::settle() {
  struct stat about {};
  if (plain_path)
    kind = ::stat(name.c_str(), &about) == 0 && S_ISCHR(about.st_mode) ? Kind::serial : Kind::local;
}

std::string Address::text() const {
  switch (kind) {
    case Kind::serial:
      return serial_text(*this);
    case Kind::local:
      return "unix:" + name;
    case Kind::tcp:
      return "tcp:" + name + ":" + std::to_string(port);
    case Kind::ros2:
      return name;
  }
  return name;
}

Address parse_address(const std::string& text) {
  Address address;
  if (text.starts_with("tcp:")) {
    parse_tcp(text, address);
    return address;
  }
  if (text.starts_with("ros2:")) {
    parse_ros2(text, address);
    return address;
  }
  if (text.starts_with("/dev/") || text.starts_with("serial:")) {
    address.kind = Address::Kind::serial;
    parse_serial(text, address);
    return address;
  }
  if (text.starts_with("unix:")) {
    address.name = text.substr(5);
    struct stat about {};
    if (::stat(address.name.c_str(), &about) == 0 && !S_ISSOCK(about.st_mode))
      throw std::invalid_argument("\"" + text + "\": expected a local socket, found " +
                                  kind_of_file(about));
  } else {
    parse_plain(text, address);
  }
  if (address.name.empty())
    throw std::invalid_argument("\"" + text + "\": expected unix:/path");
  if (address.kind == Address::Kind::local && address.name.size() >= sizeof(sockaddr_un::sun_path))
    throw std::invalid_argument("\"" + text + "\": the path of a local socket has at most " +
                                std::to_string(sizeof(sockaddr_un::sun_path) - 1) + " characters");
  return address;
}

std::string line_trouble(const Address& address) {
  if (address.kind != Address::Kind::serial || access(address.name.c_str(), R_OK | W_OK) == 0)
    return {};
  const char* const todo = errno == EACCES ? "; its users are of the group dialout"
                                           : "; the bridge waits until it is there";
  return cannot_be(address.name, "opened") + todo;
}

std::string default_address() {
  if (const char* path = std::getenv("ROBOT_SOCKET"); path != nullptr && *path != '\0')
    return path;
  return "unix:/tmp/saphira-robot-" + std::to_string(getuid());
}

}  // namespace saphira::transport
