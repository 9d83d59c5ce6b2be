// A client by lines, before a running robot.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "system.hpp"

namespace saphira::test {
namespace {

using nlohmann::json;

/// saphira-mcp, with this test as its client.
class Client {
 public:
  Client(const System& system, const std::string& name)
      : input_(system.folder().path(name + ".in")),
        server_(begin(input_, system, name)),
        pipe_(open(input_.c_str(), O_WRONLY)) {}
  ~Client() { close(pipe_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void say(int id, const std::string& method, const json& parameters) {
    const std::string line =
        json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", parameters}}.dump() +
        "\n";
    EXPECT_EQ(write(pipe_, line.data(), line.size()), static_cast<ssize_t>(line.size()));
  }
  void call(int id, const std::string& tool, const json& arguments) {
    say(id, "tools/call", {{"name", tool}, {"arguments", arguments}});
  }
  /// The result of a request, when it comes.
  json result(int id) {
    json found;
    EXPECT_TRUE(wait_until([&] {
      std::istringstream lines(server_.output());
      for (std::string line; std::getline(lines, line);)
        if (const json message = json::parse(line, nullptr, false);
            message.is_object() && message.value("id", -1) == id)
          found = message.value("result", json::object());
      return !found.is_null();
    })) << server_.output();
    return found;
  }
  Process& server() { return server_; }

 private:
  static Process begin(const std::string& input, const System& system, const std::string& name) {
    mkfifo(input.c_str(), 0600);
    return Process({"/bin/sh", "-c", "exec " + program("saphira-mcp") + " --who model <" + input},
                   system.folder().path(name + ".out"), {{"SAPHIRA_ROBOT", system.robot()}});
  }

  std::string input_;
  Process server_;
  int pipe_;
};

json point(double x, double y) {
  return {{"x", x}, {"y", y}, {"frame", "odom"}};
}

TEST(McpDoor, AModelSendsTheRobotAndItsGoalsEndWithIt) {
  System system;
  system.start_all();
  {
    Client client(system, "first");
    client.say(1, "initialize", {{"protocolVersion", "2025-06-18"}});
    EXPECT_EQ(client.result(1)["serverInfo"]["name"], "saphira");
    // The tools of the activities are there when intentions is heard.
    int id = 10;
    ASSERT_TRUE(wait_until([&] {
      client.say(++id, "tools/list", json::object());
      return client.result(id).dump().find("\"go_to\"") != std::string::npos;
    }));
    client.call(2, "go_to", {{"position", point(0.8, 0.0)}});
    EXPECT_EQ(client.result(2)["structuredContent"]["state"], "succeeded")
        << client.server().output();

    client.call(3, "go_to", {{"position", point(5.0, 0.5)}, {"wait_s", 0}});
    const std::string goal = client.result(3)["structuredContent"]["goal"];
    EXPECT_TRUE(system.wait_moving());
    client.call(4, "cancel", {{"goal", goal}});
    EXPECT_EQ(client.result(4)["content"][0]["text"], "withdrawn; the robot stands");

    client.call(5, "go_to", {{"position", point(5.0, 0.5)}, {"wait_s", 0}});
    client.result(5);
    EXPECT_TRUE(system.wait_moving());
    client.server().signal(SIGKILL);
  }
  EXPECT_TRUE(system.wait_still());
  {
    Client client(system, "second");
    client.call(1, "emergency_stop", json::object());
    EXPECT_EQ(client.result(1)["structuredContent"]["latched"], true);
  }
  EXPECT_EQ(system.truth().contacts, 0);
}

}  // namespace
}  // namespace saphira::test
