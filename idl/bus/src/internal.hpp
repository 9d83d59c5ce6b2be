#pragma once

// The parts that both transports share. Not for users of the library, but for its tests.

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saphira/bus/introspect.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bus::internal {

/// The DDS policies behind a QoS name.
struct Policies {
  bool reliable = false;
  bool transient_local = false;
  int writer_depth = 1;  ///< KEEP_LAST, per key
  int reader_depth = 1;
  int lifespan_ms = 0;   ///< [0: for ever]
  int heartbeat_ms = 0;  ///< of a reliable writer; how soon a lost sample is noticed
  /// A node that begins anew on the bus writes the samples of this writer again: a state is
  /// repeated, an event or a wish is not.
  bool kept_by_session = false;

  /// The newest sample of each key is what its writer declares, for as long as it is there.
  bool declares() const { return transient_local && writer_depth == 1; }
};

Policies policies(Qos qos, bool lockstep);
const char* qos_name(Qos qos);

/// Wakes a node's one thread: many signals until it clears are one write to its eventfd.
class Wake {
 public:
  Wake();
  ~Wake();

  void signal();
  void clear();
  /// Its thread does not sleep, and looks at pending() by itself: signals need not wake it.
  void rouse() { asleep_.store(false); }
  /// Its thread is about to poll fd(). False where a signal is pending already, which fd() may not
  /// show.
  bool rest() {
    asleep_.store(true);
    return !pending_.load();
  }
  bool pending() const { return pending_.load(std::memory_order_acquire); }
  int fd() const { return fd_; }

 private:
  int fd_;
  std::atomic<bool> pending_{false};
  std::atomic<bool> asleep_{true};
};

/// The refusals since the last call.
struct Refusals {
  std::uint64_t samples = 0;  ///< that were not of their topic's type
  /// Of these, each topic and writer once; each program that was not let in, each topic that a
  /// member may not have, and strangers.
  std::vector<std::string> texts;
};

/// One node's side of a bus.
class Transport {
 public:
  virtual ~Transport() = default;
  virtual std::unique_ptr<RawWriter> make_writer(const char* topic, const Policies& policies,
                                                 const TypeInfo& type) = 0;
  virtual std::unique_ptr<RawReader> make_reader(const char* topic, const Policies& policies,
                                                 const TypeInfo& type) = 0;
  /// Everybody's endpoints but this node's.
  virtual std::vector<EndpointEntry> endpoints() const = 0;
  /// As found_programs() has them. None on the bus in memory.
  virtual std::vector<ProgramEntry> programs() const { return {}; }
  /// As Census has them.
  virtual std::vector<OtherProgram> others() const { return {}; }
  /// Endpoints that did not match one of this node's since the last call, one text each.
  virtual std::vector<std::string> take_troubles() = 0;
  virtual Refusals take_refusals() { return {}; }
  /// True where a change of endpoints() wakes the node.
  virtual void watch_endpoints(bool watch) = 0;
  /// As Node has them.
  virtual std::vector<std::string> silent_peers() const { return {}; }
  virtual std::vector<std::string> network_waits() const { return {}; }
  /// With security, the identity of this node, and what its status says beside the program's own
  /// reason: that its certificate expires soon, and which strangers are kept out.
  virtual std::optional<Identity> identity() const { return std::nullopt; }
  virtual std::vector<std::string> notices() const { return {}; }
  /// As Node has it.
  virtual std::string bar() const { return {}; }
  /// Begins anew on the bus, as after a long sleep; soon, in a thread of its own.
  virtual void renew() {}
  /// True where a writer is one of this node's.
  virtual bool is_own(const WriterId& writer) const = 0;
};

/// instance: as in ServiceStatus.
std::unique_ptr<Transport> make_dds_transport(const NodeOptions& options, std::uint64_t instance,
                                              std::shared_ptr<Wake> wake);
/// Throws where the credentials that the options name are unusable.
void check_credentials(const NodeOptions& options);
/// Throws where the role that the options' credentials give may not write, or read, the topic.
void check_role(const NodeOptions& options, const char* topic, bool writes);
std::unique_ptr<Transport> make_memory_transport(const NodeOptions& options,
                                                 std::shared_ptr<MemoryBus> bus,
                                                 std::shared_ptr<Wake> wake);

/// True where two partitions, either of them with wildcards, overlap.
bool partitions_meet(const std::string& one, const std::string& other);
/// Why `other`, of program and host `name`, does not match our endpoint, and what to do. Nothing:
/// they match, or are not of one topic. Empty: they are of two robots, and that is no trouble,
/// though DDS reports it.
std::optional<std::string> mismatch_text(const EndpointEntry& own, const EndpointEntry& other,
                                         const std::string& name);

std::string host_name();

/// True where a node of this program that has ended had a cycle of a robot.
std::atomic<bool>& has_worked();

/// A node's transport, for tests that need a QoS that no name has.
Transport& transport_of(Node& node);
Wake& wake_of(Node& node);

}  // namespace saphira::bus::internal
