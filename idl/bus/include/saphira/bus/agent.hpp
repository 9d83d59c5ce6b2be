#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "saphira/bus/request_client.hpp"
#include "saphira/bus/request_server.hpp"

namespace saphira::bus {

/// A program that answers requests, and asks others, by way of the facilitator. For the node's own
/// thread.
///
///   Node node(options);
///   Agent agent(node, "calendar", "knows where people are");
///   agent.can(capability("place_of", "where a person is", {text_slot("person", "a name"),
///                                                          text_slot("place", "of the map")}),
///             [&](const v1::Request& request) { return done({text("place", "library")}); });
///   while (!stop.requested()) { node.wait(500ms, &stop); agent.poll(); }
///
/// Its capabilities end with the object, also when the process is killed. A process that stood
/// still, or was cut off, has them again when it is heard again.
class Agent {
 public:
  /// Its answer to a request whose arguments fit. ANSWER_UNDERWAY: the end follows by answer().
  using Answerer = std::function<v1::Answer(const v1::Request&)>;

  Agent(Node& node, std::string name, std::string summary);
  ~Agent();
  Agent(const Agent&) = delete;
  Agent& operator=(const Agent&) = delete;

  /// Announces one more capability.
  void can(const v1::Capability& capability, Answerer answerer);
  /// Answers the requests that have come. Call after each Node::wait. Not from an Answerer. The
  /// first call ends SERVICE_STARTING of the node's status.
  void poll();
  /// Ends a request that was underway. False, and nothing is told: it has ended.
  bool answer(const v1::Request& request, v1::Answer answer) {
    return server_.answer(request.asker, request.number, std::move(answer));
  }
  /// Called, perhaps repeatedly, when the asker of a request that is underway withdraws it or is
  /// gone: the work stops soon, and answer() says so. Without it the work goes on to its end.
  void when_withdrawn(std::function<void(const v1::Request&)> stop) {
    server_.when_withdrawn(std::move(stop));
  }

  /// Asks whichever agent can, and waits: see RequestClient::ask. Others are answered meanwhile.
  /// request.service: the one agent that is meant; an argument `answers`: how many are wanted.
  v1::Answer ask(const v1::Request& request, double patience, const Stop* stop = nullptr);

  /// Sets a trigger: its action is asked for when it fires, for as long as this agent lives.
  /// std::runtime_error where the bus did not take it.
  v1::GoalId set(v1::Trigger trigger);
  void take_back(const v1::GoalId& trigger);
  /// Reports an event. Triggers may wait for it.
  void tell(const std::string& functor, std::vector<v1::Argument> arguments);

 private:
  v1::Answer begin(const v1::Request& request);

  Node& node_;
  v1::Agent self_;
  Writer<v1::Agent> announcements_;
  Writer<v1::Trigger> triggers_;
  Writer<v1::AgentEvent> events_;
  Reader<v1::Request> requests_;
  Writer<v1::Answer> answers_;
  RequestServer server_;
  RequestClient solver_;
  std::map<std::string, Answerer> answerers_;
  bool answering_ = false;
};

/// The address of an agent on agents/request, such as "1f3a/calendar".
std::string agent_address(std::uint64_t id, const std::string& name);

/// A capability and its parameters. A fact: asking changes nothing, so several agents may be asked.
v1::Capability capability(const std::string& functor, const std::string& summary,
                          std::vector<v1::CapabilityParameter> parameters);
/// An action: one agent is asked, once.
v1::Capability action(const std::string& functor, const std::string& summary,
                      std::vector<v1::CapabilityParameter> parameters);
/// Required parameters, and optional ones that may be left open for the answer to fill.
v1::CapabilityParameter text_slot(const std::string& name, const std::string& meaning,
                                  bool required = false);
v1::CapabilityParameter number_slot(const std::string& name, const std::string& meaning,
                                    bool required = false);

/// Answers of an agent.
v1::Answer done(std::vector<v1::Argument> results, const std::string& text = {});
v1::Answer refused(const std::string& text);

/// The text or number of an argument of a request; nothing and 0 where it is not given.
std::string text_of(const std::vector<v1::Argument>& arguments, const std::string& name);
double number_of(const std::vector<v1::Argument>& arguments, const std::string& name);
/// An unbound argument, which the answer fills.
v1::Argument open(const std::string& name);

}  // namespace saphira::bus
