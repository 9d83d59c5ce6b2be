// The conversations of doors.txt: the test is the client, the facilitator, its agent and the robot.
#include <cmath>

#include "door_bench.hpp"
#include "saphira/idl/goal_words.hpp"
#include "transcript.hpp"

namespace saphira::mcp {
namespace {

std::vector<v1::Argument> arguments_of(const std::string& text) {
  std::vector<v1::Argument> all;
  // A list of names and values: one name may have two.
  for (const Json& each : Json::parse(text)) {
    const std::string name = each[0];
    all.push_back(each[1].is_number()    ? bus::number(name, each[1])
                  : each[1].is_boolean() ? bus::truth(name, each[1])
                                         : bus::text(name, each[1]));
  }
  return all;
}

class Visit : public DoorInMemory, public test::Transcript {
 public:
  Visit() : Transcript(DoorInMemory::session) {
    events_.insert(
        {{"turn", [this](auto& in) { passing_ = std::stod(word(in)); }},
         {"agent", [this](auto& in) { agent(in); }},
         {"drive", [this](auto& in) { drive(std::stod(word(in))); }},
         {"believe",
          [this](auto& in) {
            const std::string name = word(in);
            believe(name, word(in));
          }},
         {"report",
          [this](auto& in) {
            const std::string functor = word(in);
            report(functor, arguments_of(rest(in)));
          }},
         {"reply", [this](auto& in) { reply(rest(in), false); }},
         {"last-reply", [this](auto& in) { reply(rest(in), true); }},
         {"rover's-goal", [this](auto&) { know(tell_goal(v1::GOAL_UNDERWAY)); }},
         {"goal-of-another-program",
          [this](auto&) {
            know({.id = {other.instance(), 77}, .state = v1::GOAL_UNDERWAY});
            statuses.write(status_);
          }},
         {"activity", [this](auto& in) { schemas.write({.schemas = {{.name = rest(in)}}}); }},
         {"status", [this](auto& in) { tell(in); }},
         {"may-begin", [this](auto& in) { door->allow(rest(in) == "yes"); }},
         {"close", [this](auto& in) { door->close(rest(in)); }},
         {"another-client",
          [this](auto&) {
            door = std::make_unique<Door>(node, robot, DoorInMemory::session, "model");
          }},
         {"key",
          [this](auto& in) {
            const auto right =
                rest(in) == "watch" ? security::DoorRight::watch : security::DoorRight::drive;
            door = std::make_unique<Door>(node, robot, DoorInMemory::session, "model",
                                          security::DoorKey{"anna", right, 0, ""});
          }},
         {"bridge",
          [this](auto& in) {
            const v1::AnswerCode code = kCodes.at(word(in));
            bridge_.write(
                {.asker = stop_.asker, .number = stop_.number, .code = code, .text = rest(in)});
          }},
         {"facilitator-ends",
          [this](auto&) { solve = node.reader<v1::Request>(bus::topics::kAgentRequest); }},
         {"facilitator-begins",
          [this](auto&) { solve = other.reader<v1::Request>(bus::topics::kSolve); }}});
    facts_.insert(
        {{"request", [this] { return request(); }},
         {"request of", [this] { return request_.source; }},
         {"person", [this] { return request_.person.name + " as " + request_.person.role; }},
         {"words of", [this] { return saphira::test::only(words.take()).data.person.name; }},
         {"stop", [this] { return stop(); }},
         {"deadline", [this] { return std::to_string(std::lround(request_.deadline)); }},
         {"goal", [this] { return goal(); }},
         {"approval", [this] { return approval(); }},
         {"words", [this] { return std::to_string(words.take().size()); }},
         {"words taken back", [this] { return std::to_string(words.take_lost().size()); }},
         {"requests taken back", [this] { return std::to_string(solve.take_lost().size()); }},
         {"emergency stop", [this] { return yes(!presses.take().empty()); }},
         {"busy", [this] { return yes(door->is_busy()); }},
         {"means a program", [this] { return yes(spoken.means == v1::UTTERANCE_PROGRAM); }},
         {"asked", [this] { return yes(door->is_asked()); }},
         {"silent", [this] { return yes(door->is_silent()); }},
         {"leaves", [this] { return yes(door->leave()); }}});
    for (const char* const tool : {"sweep", "place_of", "wait_for"})
      facts_[std::string("misfit of ") + tool] = [this, tool] {
        return misfit(message_["result"]["structuredContent"], form(tool));
      };
  }
  void TestBody() override {}

 private:
  std::vector<Call> turn() override {
    DoorInMemory::turn(std::exchange(passing_, 0.0));
    return {};
  }
  static std::string word(std::istringstream& in) {
    std::string text;
    in >> text;
    return text;
  }
  void agent(std::istringstream& in) {
    const std::string code = word(in);
    const std::string more = rest(in);
    const bool finds = more.starts_with("[");
    say(request_, kCodes.at(code), finds ? "" : more,
        finds ? arguments_of(more) : std::vector<v1::Argument>());
  }
  void tell(std::istringstream& in) {
    const std::string state = word(in);
    status_.state = state == "canceled"    ? v1::GOAL_CANCELED
                    : state == "succeeded" ? v1::GOAL_SUCCEEDED
                                           : v1::GOAL_WAITING;
    EXPECT_EQ(state, word_of(status_.state));
    const std::string more = rest(in);
    status_.code = more == "for approval" ? v1::CODE_APPROVAL : v1::CODE_NONE;
    if (more == "behind it") {
      status_.waits_for = status_.id;
      ++status_.id.number;
      names_["$behind"] = bus::describe(status_.id);
      status_.requester = "model";
    }
    statuses.write(status_);
  }
  /// The goal of the lines from now on.
  void know(const v1::GoalStatus& status) {
    status_ = status;
    names_["$goal"] = bus::describe(status.id);
  }
  std::string request() {
    for (const auto& sample : solve.take())
      requests_.push_back(sample.data);
    if (requests_.empty())
      return "none";
    const v1::Request request = requests_.front();
    requests_.pop_front();
    EXPECT_TRUE(requests_.empty()) << "one more than this";
    std::string text = request.functor + (request.number == request_.number ? " again" : "");
    if (request.functor != bus::kWithdraw)
      request_ = request;
    for (const v1::Argument& argument : request.arguments)
      if (!argument.text.empty())
        text += " " + argument.name + "=" + argument.text;
    return text;
  }
  std::string goal() {
    for (const auto& sample : goals.take())
      goals_.push_back(sample.data);
    if (goals_.empty())
      return "none";
    const v1::Goal goal = goals_.front();
    goals_.pop_front();
    EXPECT_TRUE(goals_.empty()) << "one more than this";
    if (!goal.withdrawn.empty())
      return bus::describe(goal.id) + " withdrawn: " + goal.withdrawn;
    know({.id = goal.id, .functor = goal.functor});
    return goal.functor;
  }
  std::string stop() {
    const auto request = stops_.take_newest();
    stop_ = request.value_or(v1::Request());
    return !request ? "none"
                    : request->functor +
                          (request->person.name.empty() ? "" : " of " + request->person.name);
  }
  std::string approval() {
    const auto request = approvals_.take_newest();
    return !request ? "none"
                    : request->service + ": " + request->functor + " " +
                          bus::text_of(request->arguments, "process");
  }

  inline static const std::map<std::string, v1::AnswerCode> kCodes{
      {"done", v1::ANSWER_DONE},
      {"underway", v1::ANSWER_UNDERWAY},
      {"gave-up", v1::ANSWER_GIVEN_UP},
      {"lost", v1::ANSWER_LOST}};
  double passing_ = 0.0;  ///< [s]
  v1::Request request_;   ///< newest but withdrawals
  v1::GoalStatus status_;
  std::deque<v1::Request> requests_;
  std::deque<v1::Goal> goals_;
  v1::Request stop_;  ///< newest
  bus::Reader<v1::Request> stops_ = other.reader<v1::Request>(bus::topics::kDriveStop);
  bus::Writer<v1::Answer> bridge_ = other.writer(bus::topics::kRobotAnswers);
  bus::Reader<v1::Request> approvals_ = other.reader(bus::topics::kProcessRequest);
};

TEST(McpDoors, AreAsWritten) {
  EXPECT_EQ(saphira::test::play<Visit>("agents/mcp/test/doors.txt"), 36);
}

}  // namespace
}  // namespace saphira::mcp
