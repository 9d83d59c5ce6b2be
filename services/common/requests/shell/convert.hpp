#pragma once

#include "saphira/bus/endpoint.hpp"
#include "saphira/idl/request.hpp"
#include "saphira/requests/request.hpp"

/// Conversions between requests on the bus and plain ones: pure functions.
namespace saphira {

/// A kind that is not of the contract reads as unbound.
ArgumentKind from_bus(v1::ArgumentKind kind);
v1::ArgumentKind to_bus(ArgumentKind kind);
/// A frame that is not of the contract reads as odom.
Frame from_bus(v1::Frame frame);
/// Takes only the member that counts. An argument with a kind or frame that is not of the contract
/// is unbound.
Argument from_bus(const v1::Argument& argument);
v1::Argument to_bus(const Argument& argument);
Arguments from_bus(const std::vector<v1::Argument>& arguments);
std::vector<v1::Argument> to_bus(const Arguments& arguments);

/// The source, which any program may write, is cut to the length of a line, and has the asker's
/// checked identity before it.
Request from_bus(const bus::Sample<v1::Request>& sample);
v1::Request to_bus(const Request& request);

/// A code that is not of the contract reads as lost.
Answer from_bus(const v1::Answer& answer);
/// Stamp, ids and service are the caller's.
v1::Answer to_bus(const Answer& answer);

}  // namespace saphira
