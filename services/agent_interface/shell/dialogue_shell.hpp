#pragma once

#include <map>
#include <string>
#include <vector>

#include "saphira/agent_interface/dialogue.hpp"
#include "saphira/base/watched_folder.hpp"
#include "saphira/bus/agent.hpp"
#include "saphira/bus/audit.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/held.hpp"
#include "saphira/idl/goal_words.hpp"

namespace saphira::agent_interface {

struct DialogueOptions {
  std::string grammar;  ///< a file
  std::string memory;   ///< file of the knowledge over a restart; empty: none
};

/// The dialogue on the bus: utterances in and out, goals, claims and the robot's knowledge. For the
/// node's own thread.
class DialogueShell {
 public:
  /// FileError where the grammar has a mistake.
  DialogueShell(bus::Node& node, const DialogueOptions& options);

  /// Takes the inputs and carries out the results. seconds: of a clock that does not go back, in
  /// lockstep that of the cycles. now: [s] since 1970; 0: unknown, in lockstep.
  void step(double seconds = 0.0, double now = 0.0);
  /// Reads the grammar again where its file has changed; a file with an error is not accepted.
  void reload();
  /// Until stop is requested, or another dialogue of this robot has served (bus::Namesakes).
  void run(const bus::Stop& stop);

 private:
  void begin();
  void announce();
  void take_goals(double seconds);
  void adopt(std::uint64_t tag, const v1::GoalId& id);
  void take_beliefs();
  void take_places();
  void take_agents();
  void take_utterances();
  std::vector<KnownGoal> known_goals() const;
  void perform(const Dialogue::Outputs& out);
  void want(const WantedGoal& goal);
  void ask_to_stop(const WantedGoal& wanted);
  void claim(const Claimed& claim);
  void remember();
  void publish();

  bool begun_ = false;
  bus::Node& node_;
  DialogueOptions options_;
  WatchedFolder folder_;
  Dialogue dialogue_;
  bus::Agent agent_;
  bus::GoalClient goals_;
  bus::RequestClient registration_;
  bus::RequestClient stops_;
  bus::RequestClient solver_;
  bus::Reader<v1::Utterance> heard_ = node_.reader(bus::topics::kHeard);
  bus::Reader<v1::Goal> wanted_ = node_.reader(bus::topics::kGoals);
  bus::Reader<v1::Message> messages_ = node_.reader(bus::topics::kMessages);
  bus::Reader<v1::BeliefSet> beliefs_ = node_.reader(bus::topics::kBeliefs);
  bus::Reader<v1::Registration> registrations_ = node_.reader(bus::topics::kRegistration);
  bus::Held<v1::FloorMap> maps_{node_.reader(bus::topics::kMap)};
  bus::Reader<v1::Vision> visions_ = node_.reader(bus::topics::kVision);
  bus::Reader<v1::Grant> grants_ = node_.reader(bus::topics::kGrant);
  bus::Reader<v1::Agent> agents_ = node_.reader(bus::topics::kAgents);
  std::map<bus::WriterId, v1::Agent> known_agents_;
  bool knows_beliefs_ = false;
  bus::Reader<v1::RobotDescription> robots_ = node_.reader(bus::topics::kRobotDescription);
  bus::Writer<v1::Utterance> said_ = node_.writer(bus::topics::kSaid);
  bus::Writer<v1::BeliefClaim> claims_ = node_.writer(bus::topics::kBeliefClaims);
  bus::Writer<v1::Knowledge> knows_ = node_.writer(bus::topics::kKnows);
  bus::Audit audit_;
  Situation situation_;
  v1::Vision seen_;                                 ///< the newest
  std::map<std::uint64_t, v1::GoalId> asked_;       ///< by the dialogue's tag
  std::map<v1::GoalId, v1::Goal> others_;           ///< the goals of other programs
  std::vector<v1::GoalId> withdrawn_;               ///< those of them that their programs withdrew
  std::map<std::uint64_t, std::string> orphans_;    ///< goals of before the restart, by tag
  std::map<std::string, v1::BeliefClaim> claimed_;  ///< by the belief's name
  std::uint64_t number_ = 0;
};

}  // namespace saphira::agent_interface
