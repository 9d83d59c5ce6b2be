#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/durable.hpp"
#include "saphira/bus/endpoint.hpp"
#include "saphira/bus/stop.hpp"
#include "saphira/bus/topics.hpp"

namespace saphira::bus {

/// The network in one word.
enum class Profile {
  host,  ///< this machine alone: loopback only
  lan,   ///< multicast discovery on every interface, or the one that is named
  wan,   ///< no multicast: the listed peers, and the machines that those hear
};

/// The programs of other robots, to a program of one robot.
enum class Others {
  ignored,  ///< not heard at all
  noted,    ///< known by name (Census::others)
  met,      ///< exchanged with, as those of the own robot
};

/// Instead of a folder of credentials.
inline constexpr const char* kOpenBus = "none";

struct NodeOptions {
  std::string name;               ///< of the program on the bus, such as behaviors
  std::string robot = "pioneer";  ///< the partition; "*" to read every robot
  Others others = Others::ignored;
  std::uint32_t domain = 0;  ///< DDS domain [0, 231]
  Profile profile = Profile::host;
  std::vector<std::string>
      peers;                  ///< wan: addresses of other machines; one that all name is enough
  std::string interface;      ///< lan, wan: address of the one interface to use; empty: all
  bool lockstep = false;      ///< cyclic topics lose nothing and steps wait for their inputs
  std::string security;       ///< folder of credentials [empty or kOpenBus: an open bus]
  std::string program;        ///< program name, which gives its role [empty: as its name]
  bool for_terminal = false;  ///< readers hand over texts without control characters of others
  bool dry_run = false;       ///< checks the credentials only; joins nothing but a bus in memory

  Files files() const { return dry_run ? Files::kStay : Files::kChange; }
};

class Node;

/// The in-memory bus: nodes that are given the same one hear each other, without DDS, sockets or
/// threads; delivery is immediate and in order. For tests.
class MemoryBus;
class Echo;
class Scribe;
class Gateway;
namespace internal {
class Transport;
class Wake;
Transport& transport_of(Node& node);
Wake& wake_of(Node& node);
}  // namespace internal
std::shared_ptr<MemoryBus> make_memory_bus();
/// As if the program stood still, or were cut off: its endpoints count as gone until it is heard.
void set_silent(MemoryBus& bus, const std::string& program, bool silent);

/// The counts that a node publishes about itself.
struct NodeHealth {
  std::uint32_t incompatible = 0;  ///< endpoints that did not match for their QoS or their type
  std::string incompatible_text;   ///< the newest of them in words: topic, policy, endpoint
};

/// One program on the bus (a DDS participant). Makes endpoints, wakes its one thread when something
/// has come, publishes its status and its log.
///
/// Listeners only signal: samples stay in the readers until the node's thread takes them.
class Node {
 public:
  /// Throws std::runtime_error that names the cause (domain, interface, peers).
  explicit Node(NodeOptions options);
  Node(NodeOptions options, std::shared_ptr<MemoryBus> memory);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  template <class T>
  Writer<T> writer(const Topic<T>& topic) {
    return Writer<T>(make_writer(topic.name, topic.qos, type_of<T>()));
  }
  template <class T>
  Reader<T> reader(const Topic<T>& topic) {
    return Reader<T>(make_reader(topic.name, topic.qos, type_of<T>()));
  }

  /// Readable (poll, select) when a reader of this node has got something or a match has changed.
  int wake_fd() const;
  /// Makes wake_fd unreadable again. Call before taking from the readers.
  void clear_wake();
  /// Makes wake_fd readable, from any thread: for work that does not come over the bus.
  void wake();
  /// Waits for wake_fd, stop or the timeout; clears the wake. False when the time ran out.
  bool wait(std::chrono::milliseconds timeout, const Stop* stop = nullptr);

  /// Polls for a wake without sleeping, and without keeping the processor from others. For callers
  /// that expect an answer within a fraction of a millisecond, which a sleep and a wake would
  /// lengthen by half. True where there is a wake, which stays set.
  bool spin(std::chrono::microseconds limit);
  /// Until the next wait(): incoming samples need not wake this thread, which is at work and will
  /// look by itself. Not for callers that poll wake_fd.
  void rouse();

  /// For a program that cannot hear others or be heard by them: makes a new participant and all
  /// endpoints again, soon. The program's readers and writers stay valid (README.md).
  void begin_anew();

  /// wan: addresses of named peers from which no program was heard in the last minute.
  std::vector<std::string> silent_peers() const;
  /// lan, wan: in words, the missing address of this machine or of a named peer. Until the address
  /// comes, other machines are not reached; the programs of this machine are.
  std::vector<std::string> network_waits() const;
  /// In words, why programs of a site do not let this one in: it has no credentials, or those of
  /// another site. Empty where no program of another site was found.
  std::string bar() const;
  /// With security, the identity of this program; none on an open bus.
  std::optional<Identity> identity() const;

  /// The lines of the log about programs that were not let in and refused samples, since the last
  /// call; the newest 64.
  std::vector<std::string> take_refused();

  const NodeOptions& options() const;
  /// Random, one a process start: ServiceStatus.instance, and the writer part of goal ids.
  std::uint64_t instance() const;
  NodeHealth health() const;

  /// The published status. The program sets its own members; the node adds identity, health, age,
  /// CPU and memory.
  v1::ServiceStatus& status();
  /// Publishes the status when a second of the wall clock has passed since the last time, or its
  /// state or reason has changed. Call at least twice a second from the node's thread: a thread
  /// that hangs shows by its age. True where it was published.
  bool publish_status();

  /// Writes to the program's log (stderr, by spdlog) and to system/log.
  void log(v1::LogLevel level, const std::string& text);
  void info(const std::string& text) { log(v1::LOG_INFO, text); }
  void warn(const std::string& text) { log(v1::LOG_WARNING, text); }
  void error(const std::string& text) { log(v1::LOG_ERROR, text); }

 private:
  friend class Echo;
  friend class Scribe;
  friend class Gateway;
  friend internal::Transport& internal::transport_of(Node& node);
  friend internal::Wake& internal::wake_of(Node& node);

  internal::Transport& transport();
  std::unique_ptr<RawWriter> make_writer(const char* topic, Qos qos, const TypeInfo& type);
  std::unique_ptr<RawReader> make_reader(const char* topic, Qos qos, const TypeInfo& type);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saphira::bus
