#include "saphira/bus/qos.hpp"

#include "internal.hpp"
#include "saphira/base/enumerators.hpp"

namespace saphira::bus::internal {

// The one table. Reasons: idl/README.md.
Policies policies(Qos qos, bool lockstep) {
  switch (qos) {
    case Qos::cyclic:
    case Qos::motion:
      // Live, a lost sample is replaced by the next. The reader is a little deeper than the writer,
      // so that a service that was slow for one cycle still finds the sample before the newest, and
      // two writers of one role do not overwrite each other.
      // In lockstep nothing may be lost, and a program that starts later must find the cycle that
      // the others wait for.
      return lockstep ? Policies{.reliable = true,
                                 .transient_local = true,
                                 .writer_depth = 8,
                                 .reader_depth = 8,
                                 .heartbeat_ms = 50,
                                 .kept_by_session = true}
                      : Policies{.reader_depth = 4};
    case Qos::command:
      return {.reliable = true,
              .writer_depth = 16,
              .reader_depth = 64,
              .lifespan_ms = 2000,
              .heartbeat_ms = 100};
    case Qos::latched:
      // The reader keeps the samples that come between two looks: two writers of a topic without a
      // key (two bridges) are both heard, and in lockstep the sample of an earlier cycle may be
      // needed.
      return {.reliable = true,
              .transient_local = true,
              .reader_depth = 8,
              .heartbeat_ms = 100,
              .kept_by_session = true};
    case Qos::goal:
      // Not repeated after a long sleep: the wish may be over, or canceled because its agent fell
      // silent, and nobody may be there to see the robot drive off.
      return {.reliable = true, .transient_local = true, .heartbeat_ms = 100};
    case Qos::status:
      return {
          .reliable = true, .transient_local = true, .heartbeat_ms = 100, .kept_by_session = true};
    case Qos::event:
      return {.reliable = true,
              .transient_local = true,
              .writer_depth = 100,
              .reader_depth = 1000,
              .heartbeat_ms = 200};
    case Qos::presence:
      return {.reader_depth = 1};
    case Qos::recall:
      // Without a reader a sample costs only its storage.
      return {.reliable = true,
              .transient_local = true,
              .writer_depth = 600,
              .reader_depth = 600,
              .heartbeat_ms = 200};
  }
  return {};
}

const char* qos_name(Qos qos) {
  return word_of(qos, {"cyclic", "motion", "command", "goal", "latched", "event", "status",
                       "presence", "recall"});
}

}  // namespace saphira::bus::internal
