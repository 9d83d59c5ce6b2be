#pragma once

#include <string>

#include "saphira/bus/endpoint.hpp"

namespace saphira::bus {

/// The writer of a sample, for people: its own name, and with security its identity before that:
/// "karen (operator), saphira drive".
inline std::string named(const std::string& says, const SampleInfo& info) {
  if (!info.sender)
    return says;
  return info.sender->text() + (says.empty() ? "" : ", " + says);
}

}  // namespace saphira::bus
