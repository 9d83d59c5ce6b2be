#include "saphira/authority/latches.hpp"

#include <exception>

#include "saphira/base/archive.hpp"
#include "saphira/base/durable.hpp"

namespace saphira::authority {

std::string to_text(const Latches& latches) {
  return latches == Latches{} ? "" : sealed(saved(latches));
}

Latches latches_from_text(const std::string& text) {
  try {
    return text.empty() ? Latches{} : restored<Latches>(unsealed(text, ""));
  } catch (const std::exception&) {
    return {true, "unknown: the saved emergency stop cannot be read", Wait::driven};
  }
}

}  // namespace saphira::authority
