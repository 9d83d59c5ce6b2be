#pragma once

namespace saphira {

/// The functor that withdraws the request of the same asker and number, on agents/solve.
inline constexpr const char* kWithdraw = "withdraw";

}  // namespace saphira
