#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "saphira/agent_interface/triggers.hpp"
#include "saphira/idl/system.hpp"
#include "saphira/requests/request.hpp"

namespace saphira::agent_interface {

/// A request that an agent can answer.
struct Capability {
  Functor functor;
  bool acts = false;  ///< changes something: one agent is asked, once
  double cost = 0.0;  ///< the cheapest are asked first
};

struct AgentInfo {
  std::uint64_t id = 0;
  std::string name;
  std::string address;  ///< Request.service of this agent
  std::vector<Capability> capabilities;
  Checked member{};  ///< who announces it, and alone may speak for it [none on an open bus]
};

/// The functor that the facilitator answers itself: the result `live` has the ids of the triggers
/// that may fire yet, such as "1f3a:2 1f3a:5". A result of such a name says why that one waits: no
/// agent can do its action, or answer its condition.
inline constexpr const char* kLiveTriggers = "live-triggers";

/// The argument of a withdrawal that says, in words, why.
inline constexpr const char* kWhy = "why";

/// The argument that begins the next part of a conjunction: its text is the functor, and the
/// arguments after it are of that part. An unbound argument with a text is a variable of that name:
/// the first part that answers it gives its value to the parts after it.
inline constexpr const char* kAnd = "and";

/// An answer on its way to the asker, with the agent that gave it.
struct Solved {
  std::uint64_t asker = 0;
  std::uint64_t number = 0;
  std::string service;
  Answer answer;
};

/// Matches requests with the agents that can answer them, collects the answers, and requests the
/// actions of triggers (manual 2.2.8). A value without clock or bus: `now` is seconds of any clock
/// that never goes back. Nothing is done twice, also over a restart with its memory.
///
/// The parts of a conjunction are asked from left to right, each of one agent at a time. Where a
/// part has no answer, the newest part before it with a further answer goes on with that one (after
/// Prolog). Only the last part may be an action; it is asked again with other values only where it
/// was refused.
class Facilitator {
 public:
  /// self: the asker in requests of triggers. known: the time until which agents may be there that
  /// have not announced themselves yet; a request that none can answer waits for them.
  explicit Facilitator(std::uint64_t self, double known = 0.0) : self_(self), known_(known) {}

  /// False, and a warning: the agent is another member's.
  bool announce(const AgentInfo& agent);
  /// The agent's open requests go to another agent, or are answered with the reason.
  void leave(std::uint64_t agent, const Checked& by = {});

  /// A known trigger is set anew where it has changed; otherwise its firings still count. One with
  /// a period below 0.1 s is not set, and a note says so.
  void set(const Trigger& trigger, double now);
  /// True for its requester and operators, who may set it anew and take it back.
  bool may_change(const std::pair<std::uint64_t, std::uint64_t>& trigger, const Checked& who);
  /// By its writer. Its action under way is withdrawn, as a goal ends with its client.
  void take_back(const std::pair<std::uint64_t, std::uint64_t>& trigger);
  /// The trigger's writer is not heard any more: as take_back(). Its firings count when it is heard
  /// again.
  void miss(const std::pair<std::uint64_t, std::uint64_t>& trigger);
  /// By somebody else than its writer: it fires no more, whatever is heard of it again, until its
  /// writer changes it.
  void call_off(const std::pair<std::uint64_t, std::uint64_t>& trigger);
  void happened(const std::string& functor, const Arguments& arguments, double now);

  /// A new request; a known one is ignored. With the functor `withdraw`: the end of a known one,
  /// for its asker and for operators.
  void ask(const Request& request, double now);
  /// The asker no longer wants a request: no further agent gets it, and an agent that is at work on
  /// an action is told. That agent's answer is the end. why: for people.
  void withdraw(std::uint64_t asker, std::uint64_t number, const std::string& why = {});
  /// The answer of the agent at an address.
  void hear(const std::string& address, std::uint64_t asker, std::uint64_t number,
            const Answer& answer, double now, const Checked& by = {});

  struct Outputs {
    std::vector<Request> requests;  ///< to agents, by their address
    std::vector<Solved> solved;     ///< to askers
    std::vector<std::string> notes;
    std::vector<std::string> warnings;  ///< each once
    std::vector<v1::AuditEntry> audit;  ///< who asks for actions, and who is refused
    bool changed = false;  ///< the memory has changed: it is kept before the requests are sent
  };
  /// Handles deadlines and triggers, and repeats unanswered requests. Call after all of the above.
  Outputs step(double now);
  /// The time at which step() has work without new input; none: no open work.
  std::optional<double> due() const;

  /// The memory: firings of triggers with `times`, and the agents that were asked for actions.
  /// Restored before all other calls.
  template <class Archive>
  void archive(Archive& a) {
    triggers_.archive(a);
    a("begun", begun_)("askers", askers_);
  }

  std::size_t open() const { return open_.size(); }
  bool is_open(std::uint64_t asker, std::uint64_t number) const {
    return open_.contains({asker, number});
  }
  std::size_t agents() const { return agents_.size(); }

 private:
  using Id = std::pair<std::uint64_t, std::uint64_t>;  ///< asker, number
  struct Asked {
    std::uint64_t agent = 0;
    bool acts = false;
    double again = 0.0;  ///< time of the next repetition without an answer
    bool heard = false;
  };
  struct Part {
    std::string functor;
    Arguments arguments{};
    std::vector<Arguments> rows{};      ///< the variables' values by its answer that are untried
    std::vector<std::uint64_t> rest{};  ///< agents that may have a further answer
    Arguments bound{};                  ///< the variables' values for the parts after it
  };
  struct Reply {  ///< the end of a part
    std::string service;
    Answer answer;
    std::vector<std::uint64_t> rest;
    bool begun = false;  ///< an action that is done, or may be
  };
  struct Open {
    Request request;
    std::size_t wanted = 1;  ///< 0: of each
    double end = 0.0;
    std::vector<std::uint64_t> left{};  ///< capable agents that were not asked
    std::vector<Asked> asked{};         ///< and have not answered
    std::size_t got = 0;
    Answer trouble{AnswerCode::nobody};  ///< the newest failure
    std::string troubler{};
    std::optional<Id> trigger{};  ///< the trigger whose condition it is
    std::optional<Id> cause{};    ///< the trigger whose action it is
    bool unmatched = false;       ///< waits for an agent that can answer it
    bool withdrawn = false;
    std::string why{};             ///< it was withdrawn [empty: by its asker]
    std::optional<Id> whole{};     ///< the conjunction whose part it is
    bool acts = false;             ///< an agent was asked for an action
    std::vector<Part> parts{};     ///< of a conjunction
    std::size_t at = 0;            ///< the part at work
    std::size_t tries = 0;         ///< requests for its parts
    Id part{};                     ///< the newest of them
    std::size_t failed = 0;        ///< the part of `trouble`: the last one that was reached
    std::optional<Reply> reply{};  ///< of the part at work: step() goes on by it
  };
  std::optional<Answer> candidates(const Request& request, bool may_act,
                                   std::vector<std::uint64_t>& agents) const;
  std::optional<Answer> candidates(Open& open) const;
  void begin(const Request& request, std::optional<Id> trigger, double now);
  void list_triggers(const Request& request);
  void deny(const std::string& who, const std::string& what);
  bool may_speak_for(const AgentInfo& agent, const Checked& by);
  void stop_action(const Id& trigger, const std::string& why);
  std::string missing_for(const Trigger& trigger) const;
  std::optional<Answer> take_apart(Open& open) const;
  void pose(const Id& id, double now);
  void go_on(const Id& id, double now);
  bool go_back(Open& open) const;
  void match(const Id& id, double now);
  void advance(const Id& id, double now);
  void send(Open& open, std::uint64_t agent, double now);
  void tell(const Open& open, std::uint64_t agent);
  void give(const Id& id, const std::string& service, const Answer& answer);
  void end(const Id& id, const std::string& service, const Answer& answer);
  void look(const Trigger& trigger);
  void fire(const Firing& firing);
  Request request_of(const Trigger& trigger, const std::string& functor);
  std::optional<std::uint64_t> begun(const Id& id) const;
  Checked asker_of_begun(const Id& id) const;
  void note_begun(const Id& id, std::uint64_t agent);
  void forget_begun(const Id& id);
  const Capability* capability(std::uint64_t agent, const std::string& functor) const;

  std::uint64_t self_;
  double known_;
  std::uint64_t number_ = 0;
  double now_ = 0.0;
  std::map<std::uint64_t, AgentInfo> agents_;
  std::map<Id, Open> open_;
  std::vector<std::pair<Id, Solved>> ended_;  ///< newest ends, repeated on a repeated request
  Triggers triggers_{};
  std::set<std::string> strangers_{};  ///< in the address of answers that no agent has
  std::vector<std::pair<Id, std::uint64_t>> begun_{};  ///< actions and their agents, oldest first
  std::map<Id, Identity> askers_{};                    ///< of these, where the bus checks them
  Outputs out_;
};

}  // namespace saphira::agent_interface
