#pragma once

#include <gtest/gtest.h>

#include "only.hpp"
#include "saphira/mcp/session.hpp"

/// A session whose client and robot are the test.
namespace saphira::mcp::test {

inline Tool go_to() {
  return {
      "go_to", "goes to a point",
      Json::parse(R"({"type":"object","additionalProperties":false,"required":["x"],"properties":{
            "x":{"type":"number","minimum":-100,"maximum":100},
            "frame":{"type":"string","enum":["map","robot"]}}})")};
}

struct Client {
  Client() { session.set_tools({go_to()}); }
  /// The lines of the answer to a line.
  std::vector<Json> say(const std::string& line) {
    session.take(line);
    return heard();
  }
  std::vector<Json> heard() {
    std::vector<Json> all;
    for (const Line& line : session.take_lines())
      all.push_back(Json::parse(line.text));
    return all;
  }
  Json one(const std::string& line) {
    const auto all = say(line);
    EXPECT_EQ(all.size(), 1U) << line;
    return all.empty() ? Json() : all.front();
  }
  /// The only line since the last time.
  Line only() { return saphira::test::only(session.take_lines()); }
  Session session{"saphira", "1", "a robot"};
};

/// A request of the older era.
inline std::string line(int id, const std::string& method,
                        const Json& parameters = Json::object()) {
  return Json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", parameters}}.dump();
}

/// A call of go_to, as the parameters of a request.
inline const Json kGo{{"name", "go_to"}, {"arguments", {{"x", 1}}}};

/// A request of the newer era.
inline std::string modern(const std::string& id, const std::string& method,
                          Json parameters = Json::object(),
                          const Json& capabilities = Json::object()) {
  parameters["_meta"]["io.modelcontextprotocol/protocolVersion"] = Session::kModern;
  parameters["_meta"]["io.modelcontextprotocol/clientCapabilities"] = capabilities;
  return Json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", parameters}}.dump();
}

}  // namespace saphira::mcp::test
