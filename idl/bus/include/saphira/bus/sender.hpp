#pragma once

#include "saphira/bus/endpoint.hpp"
#include "saphira/idl/common.hpp"

namespace saphira::bus {

/// For whom a sample counts: its writer, or the person that the writer names (base/identity.hpp).
/// A withdrawn sample names nobody: its data are from before.
inline Checked asker_of(const SampleInfo& info, const v1::Person& person = {}) {
  const Checked writer = info.sender ? Checked(*info.sender) : std::nullopt;
  return info.disposed ? writer : acting_for(writer, {person.name, person.role});
}

inline v1::Person to_bus(const Checked& who) {
  return who ? v1::Person{who->name, who->role} : v1::Person{};
}

}  // namespace saphira::bus
