#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saphira/bus/goal_client.hpp"
#include "saphira/mcp/results.hpp"
#include "saphira/mcp/session.hpp"
#include "saphira/mcp/surroundings.hpp"
#include "saphira/security/door_keys.hpp"
#include "saphira/watch/mind.hpp"

namespace saphira::mcp {

constexpr double kWait = 20.0;  ///< [s] longest wait of a call for the end of its goal

/// The robot's state for all clients of this program, and the tools. For one thread.
class Robot {
 public:
  /// described: the names of the agents whose descriptions the model gets.
  explicit Robot(bus::Node& node, std::vector<std::string> described = {});

  /// Takes the newest samples.
  /// now: [s] of a clock that never goes back.
  void poll(double now);
  const std::vector<Tool>& tools() const { return tools_; }
  /// The activities and the agents were heard, or have been awaited for long enough.
  bool knows_tools() const;
  /// The facts of this call may still come: this program has just begun to listen.
  bool is_early(const Call& call) const;
  /// The activity or capability behind the tool of this name; null: another kind of tool.
  const v1::ActivitySchema* activity(const std::string& tool) const;
  const v1::Capability* capability(const std::string& tool) const;
  const watch::Mind& mind() const { return mind_; }
  bool moves() const;
  /// The value of a belief as in the activity language, such as t or nil; nothing: there is none.
  std::optional<std::string> belief(const std::string& name) const;
  /// The names of all beliefs, with commas.
  std::string beliefs() const;
  /// The driver, any trouble, and the robot's pose, velocity and battery.
  Result status() const;
  Result why() const;
  Result map() const { return map_of(surroundings()); }
  Result view() const { return view_of(surroundings()); }
  Result facts() const { return facts_of(knowledge_.get()); }

 private:
  void make_tools();
  Surroundings surroundings() const;
  bool has_listened() const;

  bus::Node& node_;
  const std::vector<std::string> described_;
  watch::Mind mind_;
  watch::Newest<v1::ActivitySchemas> schemas_{node_, bus::topics::kActivitySchemas};
  bus::Reader<v1::Agent> agent_reader_ = node_.reader(bus::topics::kAgents);
  watch::Newest<v1::SonarBuckets> sonars_{node_, bus::topics::kSonarBuckets};
  watch::Newest<v1::Perception> perception_{node_, bus::topics::kPerception};
  watch::Newest<v1::Vision> vision_{node_, bus::topics::kVision};
  watch::Newest<v1::FloorMap> map_{node_, bus::topics::kMap};
  watch::Newest<v1::Knowledge> knowledge_{node_, bus::topics::kKnows};
  std::optional<double> began_;  ///< [s] the first poll
  double now_ = 0.0;
  double changed_ = 0.0;  ///< [s] the newest change of the tools
  std::map<std::uint64_t, bus::Sample<v1::Agent>> agents_;
  std::vector<Tool> tools_;
  std::map<std::string, v1::ActivitySchema> activities_;  ///< by the tool's name
  std::map<std::string, v1::Capability> capabilities_;    ///< likewise
};

/// Carries out the calls of one client on the bus: goals, requests, words, and the emergency stop.
/// Its goals and actions, and the tasks that its words began, end with the client, and also when
/// this program is killed: their writer is lost then.
class Door {
 public:
  /// person: whose key the client has; none: it may do all.
  Door(bus::Node& node, const Robot& robot, Session& session, const std::string& who,
       const std::optional<security::DoorKey>& person = {});

  /// Takes samples of the bus and calls of the client. Call after each wait and Robot::poll, at
  /// least ten times a second. now: [s] of a clock that never goes back.
  void turn(double now);
  /// A goal or an action of this client, or a task that its words began, has not ended.
  bool is_busy() const;
  /// A call is not answered yet.
  bool is_asked() const { return !waiting_.empty() || !early_.empty(); }
  /// A goal waits for the client's person, and the client says nothing until then.
  bool is_silent() const;
  /// False: until further notice the client may not begin anything; others have too much underway.
  void allow(bool begins) { may_begin_ = begins; }
  const std::string& who() const { return who_; }
  /// The client sends no more: its goals, actions and words are withdrawn. True where calls are
  /// still unanswered; each is answered within its own limit.
  bool leave();
  /// Withdraws every goal and action of this client, and its words. why: for their status.
  void close(const std::string& why = {});
  /// Waits until that is acknowledged, for a second at most.
  void close_and_wait();

 private:
  /// A call without an answer yet.
  struct Waiting {
    enum class For {
      goal,
      cancel,
      answer,  ///< of a request: its client keeps the time
      words,
      estop,
      event,
      belief,
      picture
    } what = For::goal;
    std::optional<v1::GoalId> goal = std::nullopt;
    std::uint64_t number = 0;  ///< of the utterance
    double until = 0.0;        ///< [s]
    double told = -1.0;        ///< progress
    std::string words = {};    ///< of that progress
    std::string said = {};
    std::string name = {};                            ///< of the event [empty: any] or belief
    std::optional<std::string> value = std::nullopt;  ///< wanted of the belief; nothing: another
    std::string before = {};                          ///< value of the belief
    std::optional<Result> result = std::nullopt;      ///< of the event
    bool is_task = false;
    bool had_any = true;   ///< to cancel
    double still = 0.0;    ///< [s] until then a withdrawn task goes on while the robot moves
    double settled = 0.0;  ///< [s] until then a command of before may reach the wheels
  };

  /// A goal or an action that has not ended.
  struct Own {
    v1::GoalId id;
    bool withdrawn = false;
    std::string text = {};       ///< as it was asked for
    std::uint64_t question = 0;  ///< to the client's person, whether it may begin; 0: none
  };

  void hear();
  void hear_reply(const v1::Utterance& reply);
  bool needs_approval(const Own& own) const;
  void ask_for_approval();
  void begin(const Call& call);
  void refuse(const Call& call, const std::string& why);
  bool is_allowed(const Call& call);
  bool is_mine(const v1::GoalStatus& status) const;
  void ask(const Call& call, const v1::ActivitySchema& schema);
  void request(const Call& call, const v1::Capability& capability);
  void send(const Call& call, bus::RequestClient& client, v1::Request request, double patience,
            std::function<Result(const v1::Answer&)> result);
  void cancel(const Call& call);
  void cancel_other(const Call& call, const std::optional<v1::GoalId>& id);
  std::optional<v1::GoalStatus> other(const v1::GoalId& id) const;
  bool may_begin(const Call& call);
  bool has_room(const Call& call);
  void follow(const Call& call, const v1::GoalId& id);
  void await(const Call& call, const v1::GoalId& id);
  Own* own(const v1::GoalId& id);
  const Action* action(const v1::GoalId& id) const;
  bool has_ended(const v1::GoalId& id) const;
  bool has_words_underway() const;
  void take_back_words();
  void withdraw(Own& own, const std::string& why = {});
  void say(const Call& call);
  void wait_for(const Call& call);
  bool is_over(std::uint64_t number, Waiting& waiting);
  void press();
  void note();
  std::optional<v1::GoalStatus> status(const v1::GoalId& id) const;
  std::string words(const v1::GoalId& id, const v1::GoalStatus& status) const;
  Result outcome(const v1::GoalId& id) const;
  Json goals() const;

  bus::Node& node_;
  const Robot& robot_;
  Session& session_;
  const std::string who_;
  const security::DoorRight right_;
  const v1::Person person_;
  bus::GoalClient goals_;
  bus::RequestClient requests_;
  bus::RequestClient stops_;
  std::optional<bus::RequestClient> approvals_;  ///< none: this client's person may not approve
  bus::Reader<v1::Utterance> said_reader_ = node_.reader(bus::topics::kSaid);
  bus::Reader<v1::AgentEvent> event_reader_ = node_.reader(bus::topics::kAgentEvents);
  std::optional<bus::Reader<v1::CameraPicture>> picture_reader_;  ///< while a call waits for one
  std::optional<v1::CameraPicture> picture_;                      ///< of this turn
  bus::Writer<v1::Utterance> heard_writer_ = node_.writer(bus::topics::kHeard);
  bus::Writer<v1::MotorCommand> stop_writer_ = node_.writer(bus::topics::kDriveEstop);
  std::map<std::uint64_t, Waiting> waiting_;  ///< by the call
  std::vector<Call> early_;                   ///< whose facts may still come
  bool left_ = false;                         ///< the client sends no more
  bool may_begin_ = true;
  std::map<std::uint64_t, Action> actions_;  ///< by the number of their id
  std::vector<Own> own_;
  /// The words that the robot may still act on.
  struct Words {
    double since = 0.0;  ///< [s]
    bool acts = false;   ///< the robot has answered, and more answers follow
  };
  std::map<std::uint64_t, Words> words_;  ///< by the utterance
  double now_ = 0.0;
  double noted_since_ = 0.0;  ///< [s]
  std::size_t noted_ = 0;     ///< lines of the log in that second
};

}  // namespace saphira::mcp
