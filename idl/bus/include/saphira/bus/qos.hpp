#pragma once

namespace saphira::bus {

/// Quality of service by name. src/qos.cpp has the table of policies, idl/README.md the reasons. No
/// endpoint sets a policy by itself, so a writer and a reader of a topic agree.
enum class Qos {
  cyclic,    ///< periodic state; only the newest counts (in lockstep: none is lost)
  motion,    ///< motor commands; as cyclic, the age is checked by the receiver
  command,   ///< one-shot requests that stale quickly
  goal,      ///< keyed, reliable; writing again changes, disposing withdraws
  latched,   ///< the newest value of each key, also for late joiners, while its writer lives
  event,     ///< the last few events, also for late joiners
  status,    ///< keyed presence of programs
  presence,  ///< a heartbeat whose loss is noticed within a second
  recall,    ///< the last minute of a cyclic topic, on demand
};

}  // namespace saphira::bus
