// Messages of a language model's client to the MCP server, one per line: each is accepted or gets
// an error, each call has arguments that fit its tool, and every line to the client is JSON.

#include <string>

#include "fuzz.hpp"
#include "saphira/mcp/session.hpp"

using namespace saphira::mcp;

void saphira::fuzz::run(std::string_view text) {
  static const Tool kTool{
      .name = "go_to",
      .description = "goes",
      .input = Json::parse(
          R"({"type":"object","additionalProperties":false,"required":["x"],"properties":{
        "x":{"type":"number","minimum":-100,"maximum":100},"frame":{"type":"string","enum":["map"]}}})"),
      .lasts = true};
  static const Tool kWhy{"why", "says why", Json::parse(R"({"type":"object","properties":{}})"),
                         true};
  Session session("saphira", "1", "a robot");
  session.set_tools({kTool, kWhy});
  std::uint64_t count = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    ++count;
    // Lines, and requests of HTTP in turn; a third of the latter is closed.
    const Headers headers{count % 4 == 0 ? Session::kModern : "", "tools/call", "go_to"};
    session.turn(0.5 * static_cast<double>(count));
    session.wait_for_tools(count % 5 == 4);
    session.take(text.substr(0, end), count, count % 2 == 0 ? &headers : nullptr);
    if (count % 3 == 0)
      session.close(count);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    for (const Call& call : session.take_calls()) {
      require(call.tool != kTool.name || misfit(call.arguments, kTool.input).empty());
      if (call.as_task)
        session.begin_task(call.number, std::to_string(call.number), "begun");
      session.progress(call.number, 0.5, "half");
      if (call.number % 2 == 0)
        session.answer(call.number, {"done " + std::to_string(count), call.arguments, false});
    }
    session.take_given_up();
    if (text.empty())
      session.end();
    for (const saphira::mcp::Line& line : session.take_lines())
      require(Json::accept(line.text) && line.text.find('\n') == std::string::npos);
  }
}
