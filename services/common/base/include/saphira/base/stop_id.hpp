#pragma once

#include <cstdint>

namespace saphira {

/// A stop: the request for it, unique for ever. {0, 0}: none.
struct StopId {
  std::uint64_t asker = 0;
  std::uint64_t number = 0;

  friend bool operator==(const StopId&, const StopId&) = default;
};

}  // namespace saphira
