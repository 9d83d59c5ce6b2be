#pragma once

// Messages of ROS 2 as bytes, and the two ways in which services are asked.

#include <exception>
#include <optional>
#include <string>

#include "cdr.hpp"
#include "saphira/bus/foreign.hpp"
#include "saphira/ros2/messages.hpp"
#include "saphira/ros2_idl/members.hpp"

namespace saphira::ros2 {

template <class T>
std::string bytes_of(const T& message) {
  std::string bytes(bus::internal::cdr_size(message), '\0');
  bus::internal::write_cdr(message, bytes.data(), bytes.size());
  return bytes;
}

/// As bytes for a distribution: earlier ones lack the last members of some messages.
template <class T>
std::string bytes_of(const T& message, Distribution distribution) {
  std::string bytes = bytes_of(message);
  if constexpr (std::is_same_v<T, Range>) {
    if (distribution == Distribution::humble)
      bytes.resize(bytes.size() - sizeof(float));
  } else if constexpr (std::is_same_v<T, ResultResponse>) {
    if (distribution == Distribution::iron)
      bytes.resize(8);  // encapsulation, status, error_code
    if (distribution == Distribution::humble)
      bytes = bytes.substr(0, 5) + '\0';  // the member of Empty
  }
  return bytes;
}

/// Nothing: these are no such message.
template <class T>
std::optional<T> read(std::string bytes) {
  try {
    T message;
    bus::internal::read_cdr(bytes.data(), bytes.size(), message);
    return message;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

/// The address of an answer. ROS 2's two middlewares differ: Cyclone's requests and
/// answers begin with 16 bytes, the client's number and the request's; Fast RTPS' answers name the
/// request beside their bytes.
struct Ticket {
  std::string head;  ///< before the members of the answer [empty: Fast RTPS]
  bus::SampleId request;
};

/// Nothing: too short.
std::optional<Ticket> ticket_of(const bus::ForeignSample& request);
/// The bytes of a request without what only one of the two has.
std::string plain(const bus::ForeignSample& request, const Ticket& ticket);
/// The bytes of an answer.
std::string answer(const std::string& bytes, const Ticket& ticket);

}  // namespace saphira::ros2
