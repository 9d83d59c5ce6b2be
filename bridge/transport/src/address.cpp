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

std::string serial_text(const Address& address) {
  std::string out = address.name.starts_with("/dev/") ? "" : "serial:";
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
  if (address.name.empty() || address.name.front() != '/')
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

}  // namespace

std::string Address::text() const {
  switch (kind) {
    case Kind::serial:
      return serial_text(*this);
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
  if (text.starts_with("/dev/") || text.starts_with("serial:")) {
    address.kind = Address::Kind::serial;
    parse_serial(text, address);
    return address;
  }
  address.kind = Address::Kind::local;
  address.name = text.starts_with("unix:") ? text.substr(5) : text;
  if (address.name.empty() || (!text.starts_with("unix:") && text.front() != '/'))
    throw std::invalid_argument(
        "\"" + text +
        "\": expected a robot's address: /dev/tty...[@baud], serial:/path[@baud], unix:/path or "
        "tcp:host:port");
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
