#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mind.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/mcp/session.hpp"

namespace saphira::mcp {

/// Carries out the calls of one session on the bus: goals, questions, words, and the emergency
/// stop. What it asked for ends with it, also when it is killed (Goal.writer_lost).
class Door {
 public:
  Door(bus::Node& node, Session& session, const std::string& who);

  /// Takes what has come on the bus and from the client. Call after each wait, ten times a second
  /// at least.
  void turn();
  /// Withdraws every goal of this session, and waits until that is heard.
  void close();

 private:
  using Clock = std::chrono::steady_clock;

  /// A call that waits for something.
  struct Waiting {
    enum class For { goal, cancel, words, stop } what = For::goal;
    std::optional<v1::GoalId> goal = std::nullopt;
    std::uint64_t words = 0;  ///< number of the utterance
    Clock::time_point until = {};
    double told = -1.0;  ///< progress
    std::string said = {};
  };

  void take_schemas();
  void begin(const Call& call);
  void ask(const Call& call, const v1::ActivitySchema& schema);
  void cancel(const Call& call);
  void look(const Call& call);
  bool is_over(std::uint64_t number, Waiting& waiting);
  void press();
  Result outcome(const v1::GoalId& id) const;
  Result status() const;
  Json goals() const;
  bool moves() const;

  bus::Node& node_;
  Session& session_;
  const std::string who_;
  cli::Mind mind_;
  bus::GoalClient goals_;
  bus::Reader<v1::ActivitySchemas> schema_reader_;
  bus::Reader<v1::Utterance> said_reader_;
  bus::Writer<v1::Utterance> heard_writer_;
  bus::Writer<v1::MotorCommand> stop_writer_;
  std::map<std::string, v1::ActivitySchema> schemas_;  ///< by the tool's name
  std::map<std::uint64_t, Waiting> waiting_;           ///< by the call
  std::vector<v1::GoalId> own_;
  std::uint64_t utterances_ = 0;
};

}  // namespace saphira::mcp
