// The conversations of sessions.txt: the test is the client and the robot.
#include "transcript.hpp"

namespace saphira::mcp {
namespace {

Tool reading(const std::string& name) {
  return {name, "", Json{{"type", "object"}, {"properties", Json::object()}}, true};
}

Tool tool(const std::string& name) {
  Tool made = name == "why" || name == "map" ? reading(name) : test::go_to();
  made.name = name;
  made.lasts = name == "drive";
  made.apart = name == "back_off";
  made.always = name == "stop";
  if (name == Session::kOthers || name == "stop")
    made.input = Json::parse(R"({"type":"object","properties":{"name":{"type":"string"},
                        "arguments":{"type":"object"}},"additionalProperties":false})");
  return made;
}

class Talk : test::Client, public test::Transcript {
 public:
  Talk() : Transcript(session) {
    events_.insert({{"tools",
                     [this](auto& in) {
                       std::vector<Tool> all;
                       for (std::string name; in >> name;)
                         all.push_back(tool(name));
                       session.set_tools(all);
                     }},
                    {"waits", [this](auto& in) { session.wait_for_tools(rest(in) == "yes"); }},
                    {"turn",
                     [this](auto& in) {
                       double time = 0.0;
                       double date = 0.0;
                       in >> time >> date;
                       session.turn(time, date);
                     }},
                    {"answer", [this](auto& in) { answer(in, false); }},
                    {"fail", [this](auto& in) { answer(in, true); }},
                    {"progress",
                     [this](auto& in) {
                       const std::uint64_t call = number(in);
                       double value = 0.0;
                       in >> value;
                       session.progress(call, value, rest(in));
                     }},
                    {"knows",
                     [this](auto&) {
                       take(R"(can {"extensions":{"io.modelcontextprotocol/tasks":{}}})");
                       session.set_tools({tool("drive")});
                     }},
                    {"task",
                     [this](auto& in) {
                       const std::uint64_t call = number(in);
                       take("> c@5 call drive {\"x\":1} => call " + std::to_string(call) +
                            " as task");
                       session.begin_task(call, rest(in), "asked for");
                     }},
                    {"ask",
                     [this](auto& in) {
                       const std::uint64_t call = number(in);
                       asked_ = session.ask_person(rest(in), call);
                     }},
                    {"take-back", [this](auto& in) { session.take_back(number(in)); }},
                    {"close", [this](auto& in) { session.close(number(in)); }},
                    {"ping", [this](auto&) { session.ping(); }},
                    {"end", [this](auto&) { session.end(); }}});
    facts_.insert({{"asked", [this] { return std::to_string(asked_); }},
                   {"leaves", [this] { return yes(session.leave()); }},
                   {"open 1", [this] { return yes(session.is_open(1)); }},
                   {"open 2", [this] { return yes(session.is_open(2)); }},
                   {"silent for 1", [this] { return yes(session.is_silent_for(1)); }},
                   {"given up", [this] { return given_up(); }},
                   {"consents", [this] { return consents(); }},
                   {"outcomes", [this] { return outcomes(); }}});
  }

 private:
  std::vector<Call> turn() override { return session.take_calls(); }
  static std::uint64_t number(std::istringstream& in) {
    std::uint64_t value = 0;
    EXPECT_TRUE(in >> value);
    return value;
  }
  /// A text, and a value as JSON behind it.
  void answer(std::istringstream& in, bool is_error) {
    const std::uint64_t call = number(in);
    const std::string text = rest(in);
    const std::size_t value = text.find(" {");
    session.answer(
        call, {text.substr(0, value),
               value == std::string::npos ? Json() : Json::parse(text.substr(value)), is_error});
  }
  std::string given_up() {
    std::string all;
    for (const std::uint64_t call : session.take_given_up())
      all += (all.empty() ? "" : " ") + std::to_string(call);
    return all;
  }
  std::string consents() {
    std::string all;
    for (const auto& [question, is] : session.take_consents())
      all += (all.empty() ? "" : ", ") + std::to_string(question) + " " + yes(is);
    return all;
  }
  std::string outcomes() {
    std::string all;
    for (const Outcome& each : session.take_outcomes())
      all +=
          (all.empty() ? "" : " | ") + each.tool + (each.is_error ? " failed: " : ": ") + each.text;
    return all;
  }

  std::uint64_t asked_ = 0;
};

TEST(McpSessions, AreAsWritten) {
  EXPECT_EQ(saphira::test::play<Talk>("agents/mcp/test/sessions.txt"), 46);
}

}  // namespace
}  // namespace saphira::mcp
