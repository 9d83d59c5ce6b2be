#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/bus/node.hpp"

namespace saphira::bus {

/// A topic of this version's contract, in words.
struct TopicEntry {
  std::string name;  ///< such as robot/state
  std::string type;  ///< such as saphira::v1::RobotState
  std::string qos;   ///< such as cyclic
};

/// Every topic of topics.hpp, in that order.
std::vector<TopicEntry> known_topics();

/// The beginning of the JSON of a withdrawn instance.
inline constexpr std::string_view kDisposed = R"({"_disposed":true,)";

/// Reads one topic by its name and tells each sample as JSON: members as in the IDL, enumerators by
/// name, NaN and infinities as null. A withdrawn instance begins with kDisposed.
class Echo {
 public:
  /// Throws std::runtime_error that names the known topics where `topic` is none of them.
  Echo(Node& node, const std::string& topic);
  ~Echo();

  /// One JSON object for each sample that has come since the last call, on one line, oldest first.
  std::vector<std::string> take_json();
  /// How many writers are matched.
  std::size_t matched() const;

 private:
  std::unique_ptr<RawReader> reader_;
  const TypeInfo* type_ = nullptr;
};

/// Writes one topic by its name. Samples are JSON objects as Echo gives them. Members that an
/// object does not name are 0, false or empty.
class Scribe {
 public:
  /// Throws std::runtime_error that names the known topics where `topic` is none of them.
  Scribe(Node& node, const std::string& topic);
  ~Scribe();

  /// std::invalid_argument gives the place of an error in the object; nothing is written then.
  /// False where the bus did not take the sample.
  bool write(const std::string& json);
  /// Withdraws the instance that was written last.
  bool dispose();
  /// Withdraws the instance whose key this object has. Errors as write().
  bool dispose(const std::string& json);
  bool wait_acknowledged(int timeout_ms);
  std::size_t matched() const;

 private:
  const TypeInfo* type_ = nullptr;
  std::unique_ptr<RawWriter> writer_;
  std::shared_ptr<void> sample_;
};

/// Sets the members that a JSON object names in a sample of the contract, such as a
/// v1::MotorCommand. Throws as Scribe::write.
template <class T>
void from_json(const std::string& json, T& sample) {
  type_of<T>().parse(json, &sample);
}

/// One reader or writer that was discovered on the bus.
struct EndpointEntry {
  std::string topic;
  std::string type;
  bool writer = false;
  std::string program;  ///< the participant's name
  std::string host;     ///< empty where the participant does not say it
  std::uint32_t pid = 0;
  std::string robot;  ///< the partition; several are separated by commas
  bool reliable = false;
  std::string durability;  ///< volatile, transient_local, transient, persistent
  double deadline = 0.0;   ///< [s] [0: none]
  std::string liveliness;  ///< automatic, or the kind with its lease, such as manual_by_topic 0.3 s
  std::string ownership;   ///< shared, exclusive
  std::string id;          ///< GUID in hexadecimal: unique
  bool known_type = true;  ///< false: our topic with another type
  std::string denied;  ///< with security: the reason why its program may not have it; empty: it may
};

/// A program that discovery has found: of this robot, or of all where the node meets the others.
/// Its endpoints are discovered after it.
struct ProgramEntry {
  std::array<std::uint8_t, 12> id{};  ///< the beginning of its WriterIds
  std::string name;
  std::string program{};   ///< such as bridge, whatever its name; empty where it does not say it
  std::string host{};      ///< empty where it does not say it
  std::uint32_t pid = 0;   ///< 0: not built on this library
  std::string robot{};     ///< empty where it does not say it
  std::string contract{};  ///< as in version(); empty where it does not say it
  std::string subject{};   ///< of the certificate that it announces; empty: it has none
  bool let_in = true;      ///< false: it has not proved that it is a member of the site
  bool refused = false;    ///< it has failed to prove it
  bool silent = false;     ///< its presence is not heard
  double known = 0.0;      ///< [s] since it was found
  std::size_t endpoints = 0;

  /// Its kind, such as bridge: its name where it does not say it.
  const std::string& kind() const { return program.empty() ? name : program; }
};

/// A program of another robot.
struct OtherProgram {
  std::string robot;
  std::string name;
  auto operator<=>(const OtherProgram&) const = default;
};

/// Two endpoints of one topic and one robot that do not hear each other.
struct Mismatch {
  EndpointEntry writer;
  EndpointEntry reader;
  std::string why;  ///< such as "reliability: offered best effort, requested reliable"
};

/// The participants of the bus, without this node. Discovery goes on in the background; on one
/// machine it is usually complete after some tenths of a second.
class Census {
 public:
  /// From now on a change of the census wakes the node too.
  explicit Census(Node& node);
  ~Census();

  /// Sorted by topic, writers first, then program.
  std::vector<EndpointEntry> endpoints() const;
  /// The programs of other robots that announced themselves lately, for a node that notes them.
  /// Sorted.
  std::vector<OtherProgram> others() const;
  /// Pairs on one topic with a common partition that cannot match, and why.
  std::vector<Mismatch> mismatches() const;

 private:
  Node* node_;
};

/// The programs that discovery has found, without this one. Sorted by name, then process.
std::vector<ProgramEntry> found_programs(Node& node);

/// Why a writer's samples do not reach a reader of its topic; empty where they do. Partitions that
/// are disjoint are not a mismatch but two robots.
std::string why_incompatible(const EndpointEntry& writer, const EndpointEntry& reader);

}  // namespace saphira::bus
