#pragma once

#include <string>
#include <string_view>

namespace saphira::viewer {

/// The JSON Schema of every type of idl/*.idl.
std::string_view contract();

/// The JSON Schema of a type of the contract, such as saphira::v1::RobotState, as viewers read it:
/// in one piece, each place with one type. A number that is unknown is null in a sample. An empty
/// object's schema where the contract has no such type.
std::string schema_of(const std::string& type);

}  // namespace saphira::viewer
