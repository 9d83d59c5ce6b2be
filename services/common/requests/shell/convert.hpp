#pragma once

#include "request.h"
#include "saphira/requests/request.hpp"

/// Between requests on the bus and plain ones: pure functions, nothing else.
namespace saphira {

/// A kind that is none of the contract's reads as unbound.
ArgumentKind from_bus(v1::ArgumentKind kind);
v1::ArgumentKind to_bus(ArgumentKind kind);
/// Of the members, only the one that counts is taken over. One of a kind or frame that is none of
/// the contract's is unbound.
Argument from_bus(const v1::Argument& argument);
v1::Argument to_bus(const Argument& argument);
Arguments from_bus(const std::vector<v1::Argument>& arguments);
std::vector<v1::Argument> to_bus(const Arguments& arguments);

/// The source, as any program may write one, is cut to what a line can hold.
Request from_bus(const v1::Request& request);
v1::Request to_bus(const Request& request);

/// A code that is none of the contract's reads as lost.
Answer from_bus(const v1::Answer& answer);
/// Stamp, ids and service are the caller's.
v1::Answer to_bus(const Answer& answer);

}  // namespace saphira
