#pragma once

#include <string>
#include <vector>

#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/requests/request.hpp"

namespace saphira::agent_interface {

/// The agent "robot": each activity of the intentions is an action that agents and triggers may
/// request of the facilitator. The request becomes a goal, and is answered with the goal's end. For
/// the node's own thread.
class RobotAgent {
 public:
  explicit RobotAgent(bus::Node& node);

  /// Request.service that means this agent.
  const std::string& address() const { return address_; }
  /// Asks for the goal of a request. With the functor `withdraw`: cancels it.
  Answer begin(const Request& request, double now);

  struct Report {
    Request request;
    Answer answer;
  };
  /// Answers: the ends of goals, and at intervals that a goal is underway. now: [s] of a clock that
  /// never goes back.
  std::vector<Report> step(double now);

 private:
  void announce(const v1::ActivitySchemas& schemas);

  struct Begun {
    Request request;
    v1::GoalId goal;
    double when = 0.0;      ///< [s]
    double reported = 0.0;  ///< [s]
  };

  v1::Agent self_;
  std::string address_;
  bus::Writer<v1::Agent> announcements_;
  bus::GoalClient goals_;
  bus::Reader<v1::ActivitySchemas> schemas_;
  std::vector<Begun> begun_;
};

}  // namespace saphira::agent_interface
