// A client by lines, with a running robot.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
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

/// Waits until the intentions service has said its activities.
bool wait_activities(System& system) {
  auto reader = system.node().reader(bus::topics::kActivitySchemas);
  return wait_until([&] { return reader.take_newest().has_value(); });
}

TEST(McpDoor, AModelSendsTheRobotAndItsGoalsEndWithIt) {
  System system;
  system.start_all();
  ASSERT_TRUE(wait_activities(system));
  {
    Client client(system, "first");
    client.say(1, "initialize", {{"protocolVersion", "2025-06-18"}});
    EXPECT_EQ(client.result(1)["serverInfo"]["name"], "saphira");
    // The first list waits for the activities.
    client.say(10, "tools/list", json::object());
    const std::string tools = client.result(10).dump();
    ASSERT_NE(tools.find("\"go_to\""), std::string::npos);
    EXPECT_NE(tools.find("\"go_to_place\""), std::string::npos);
    EXPECT_EQ(tools.find("\"follow_path\""), std::string::npos);  // part of others
    client.call(2, "go_to", {{"position", point(0.8, 0.0)}});
    EXPECT_EQ(client.result(2)["structuredContent"]["state"], "succeeded")
        << client.server().output();
    EXPECT_TRUE(wait_until(
        [&] { return client.server().output().find("model: go_to: goal ") != std::string::npos; }));

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

TEST(McpDoor, ACallThatWasReadIsAnsweredAfterTheEndOfTheInput) {
  System system;
  system.start_all();
  ASSERT_TRUE(wait_activities(system));
  const std::string line =
      R"({"jsonrpc":"2.0","id":1,"method":"tools/call","params":{"name":"robot_status"}})";
  Process server({"/bin/sh", "-c", "echo '" + line + "' | " + program("saphira-mcp")},
                 system.folder().path("piped.out"), {{"SAPHIRA_ROBOT", system.robot()}});
  EXPECT_EQ(server.wait(), 0);
  EXPECT_NE(server.output().find("\"isError\":false"), std::string::npos) << server.output();
  EXPECT_EQ(server.output().find("which program drives is not known"), std::string::npos)
      << server.output();
}

int connected(int port) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const timeval patience{.tv_sec = 30, .tv_usec = 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  return fd;
}

/// As a client names this server that comes to it by no proxy.
std::string host(int port) {
  return "\r\nHost: localhost:" + std::to_string(port);
}

/// The answer to a request of HTTP, until the server closes. next: what follows in the same packet.
std::string http(int port, const std::string& head, const std::string& body = {},
                 const std::string& next = {}) {
  const int fd = connected(port);
  const std::string text = head + host(port) +
                           "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" +
                           body + next;
  EXPECT_EQ(write(fd, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  std::string answer;
  char buffer[4096];
  for (ssize_t n = read(fd, buffer, sizeof buffer); n > 0; n = read(fd, buffer, sizeof buffer))
    answer.append(buffer, static_cast<std::size_t>(n));
  close(fd);
  return answer;
}

/// Reads an open answer until it has this text. False: the text does not come.
bool comes(int fd, const std::string& text) {
  std::string answer;
  char buffer[4096];
  while (answer.find(text) == std::string::npos) {
    const ssize_t n = read(fd, buffer, sizeof buffer);
    if (n <= 0)
      return false;
    answer.append(buffer, static_cast<std::size_t>(n));
  }
  return true;
}

/// The message in an answer of HTTP, or in the last event of a stream.
json message_of(const std::string& answer) {
  const std::size_t event = answer.rfind("data: ");
  const std::size_t body = answer.find("\r\n\r\n");
  return json::parse(answer.substr(event != std::string::npos ? event + 6 : body + 4), nullptr,
                     false);
}

std::string value_of(const std::string& answer, const std::string& header) {
  const std::size_t at = answer.find(header);
  return at == std::string::npos
             ? ""
             : answer.substr(at + header.size(), answer.find('\r', at) - at - header.size());
}

TEST(McpDoor, ByHttpTheRobotIsSentAndStandsWhenTheClientEnds) {
  System system;
  system.start_all();
  ASSERT_TRUE(wait_activities(system));
  const std::string file = system.folder().path("token");
  Process server({program("saphira-mcp"), "--http", "0", "--token-file", file, "--person-keys",
                  system.folder().path("door-keys")},
                 system.folder().path("http.out"), {{"SAPHIRA_ROBOT", system.robot()}});
  int port = 0;
  ASSERT_TRUE(wait_until([&] {
    return std::sscanf(server.output().c_str(), "http://127.0.0.1:%d/mcp", &port) == 1;
  })) << server.output();
  std::string token;
  std::ifstream(file) >> token;
  const std::string post = "POST /mcp HTTP/1.1\r\nAuthorization: Bearer " + token;

  EXPECT_TRUE(http(port, "POST /mcp HTTP/1.1", "{}").starts_with("HTTP/1.1 401"));
  const std::string behind =
      "POST /mcp HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello";
  EXPECT_TRUE(http(port, post + "x", "{}", behind).starts_with("HTTP/1.1 401"));
  EXPECT_TRUE(
      http(port, post + "\r\nOrigin: http://evil.example", "{}").starts_with("HTTP/1.1 403"));
  EXPECT_TRUE(http(port, post, std::string(1'100'000, ' ')).starts_with("HTTP/1.1 413"));
  // A person's key, from when it is made until it is revoked.
  const std::string keys = system.folder().path("door-keys");
  const auto keys_say = [&](const std::string& words) {
    Process process({"/bin/sh", "-c", program("saphira") + " keys " + words + " --file " + keys},
                    system.folder().path("keys.out"));
    EXPECT_EQ(process.wait(), 0) << process.output();
    return process.output();
  };
  const std::string shown = keys_say("add anna");
  const std::string anna =
      "POST /mcp HTTP/1.1\r\nAuthorization: Bearer " + shown.substr(shown.find('\n') + 1, 32);
  const char* const initialize =
      R"({"id":1,"method":"initialize","params":{"protocolVersion":"2025-11-25"}})";
  std::string hers;
  ASSERT_TRUE(wait_until([&] {
    hers = http(port, anna, initialize);
    return hers.starts_with("HTTP/1.1 200");
  })) << hers;
  const std::string of_her = "\r\nMcp-Session-Id: " + value_of(hers, "mcp-session-id: ");
  const char* const ping = R"({"id":2,"method":"ping"})";
  EXPECT_TRUE(http(port, anna + of_her, ping).starts_with("HTTP/1.1 200"));
  EXPECT_TRUE(http(port, post + of_her, ping).starts_with("HTTP/1.1 403")) << "another's session";
  keys_say("revoke anna");
  EXPECT_TRUE(
      wait_until([&] { return http(port, anna + of_her, ping).starts_with("HTTP/1.1 401"); }));
  EXPECT_TRUE(http(port, post, R"({"id":1,"method":"ping"})").starts_with("HTTP/1.1 400"));

  // The older era, with a session.
  const auto begin = [&] {
    const std::string begun = http(
        port, post, R"({"id":1,"method":"initialize","params":{"protocolVersion":"2025-11-25"}})");
    EXPECT_EQ(message_of(begun)["result"]["protocolVersion"], "2025-11-25") << begun;
    return post + "\r\nMcp-Session-Id: " + value_of(begun, "mcp-session-id: ");
  };
  std::string session = begin();
  EXPECT_TRUE(
      http(port, session, R"({"method":"notifications/initialized"})").starts_with("HTTP/1.1 202"));
  ASSERT_NE(http(port, session, R"({"id":2,"method":"tools/list"})").find("\"go_to\""),
            std::string::npos);
  const auto go = [](double x, double wait) {
    return json{{"name", "go_to"}, {"arguments", {{"position", point(x, 0.0)}, {"wait_s", wait}}}};
  };
  const auto call = [&](const json& parameters) {
    return message_of(
        http(port, session,
             json{{"id", 3}, {"method", "tools/call"}, {"params", parameters}}.dump()))["result"];
  };
  // A stream carries what no request asks for.
  const auto listen = [&] {
    const int fd = connected(port);
    std::string get = session;
    get.replace(0, 4, "GET") += host(port) + "\r\n\r\n";
    EXPECT_EQ(write(fd, get.data(), get.size()), static_cast<ssize_t>(get.size()));
    EXPECT_TRUE(comes(fd, "text/event-stream"));
    return fd;
  };
  const int stream = listen();
  http(port, session,
       R"({"id":3,"method":"resources/subscribe","params":{"uri":"saphira://robot/goals"}})");
  EXPECT_EQ(call(go(0.4, 20))["structuredContent"]["state"], "succeeded");
  EXPECT_TRUE(comes(stream, "notifications/resources/updated"));
  close(stream);

  // A task is polled to its end.
  const auto ask = [&](const std::string& method, const std::string& name, json parameters,
                       const std::string& more = {}) {
    parameters["_meta"] = {{"io.modelcontextprotocol/protocolVersion", "2026-07-28"},
                           {"io.modelcontextprotocol/clientCapabilities",
                            {{"extensions", {{"io.modelcontextprotocol/tasks", json::object()}}}}}};
    return message_of(http(port,
                           post + "\r\nMCP-Protocol-Version: 2026-07-28\r\nMcp-Method: " + method +
                               "\r\nMcp-Name: " + name + more,
                           json{{"id", 5}, {"method", method}, {"params", parameters}}.dump()));
  };
  const json task = ask("tools/call", "go_to", go(0.7, 20))["result"];
  EXPECT_EQ(task["status"], "working");
  json state;
  EXPECT_TRUE(wait_until([&] {
    state = ask("tasks/get", task["taskId"], {{"taskId", task["taskId"]}})["result"];
    return state["status"] == "completed";
  })) << state.dump();
  EXPECT_EQ(state["result"]["structuredContent"]["state"], "succeeded");

  // A client is killed in a call: its connection closes. In the newer era, without a session, the
  // connection is the call.
  json modern = go(5.0, 20);
  modern["_meta"] = {{"io.modelcontextprotocol/protocolVersion", "2026-07-28"},
                     {"io.modelcontextprotocol/clientCapabilities", json::object()}};
  const auto drive = [&](const std::string& head, const json& parameters) {
    const std::string body =
        json{{"id", 1}, {"method", "tools/call"}, {"params", parameters}}.dump();
    const std::string text = head + host(port) +
                             "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" +
                             body;
    const int fd = connected(port);
    EXPECT_EQ(write(fd, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    EXPECT_TRUE(system.wait_moving());
    return fd;
  };
  const std::string newer =
      post + "\r\nMCP-Protocol-Version: 2026-07-28\r\nMcp-Method: tools/call\r\nMcp-Name: go_to";
  close(drive(newer, modern));
  EXPECT_TRUE(system.wait_still());
  close(drive(session, go(5.0, 20)));
  EXPECT_TRUE(system.wait_still());

  // A client is killed between its calls: its stream closes. One that comes back hears of its
  // goals.
  int held = listen();
  call(go(5.0, 0));
  EXPECT_TRUE(system.wait_moving());
  close(held);
  EXPECT_TRUE(system.wait_still());
  const json goals = call({{"name", "goals"}})["structuredContent"]["goals"];
  EXPECT_EQ(goals.back()["yours"], true);
  EXPECT_NE(goals.back()["reason"].get<std::string>().find("no stream and no call open"),
            std::string::npos)
      << goals.back();

  // A goal that outlasts its call ends with its session.
  held = listen();
  call(go(5.0, 0));
  EXPECT_TRUE(system.wait_moving());
  std::string end = session;
  EXPECT_TRUE(http(port, end.replace(0, 4, "DELETE")).starts_with("HTTP/1.1 200"));
  EXPECT_TRUE(system.wait_still());
  EXPECT_TRUE(http(port, session, R"({"id":4,"method":"ping"})").starts_with("HTTP/1.1 404"));
  EXPECT_FALSE(comes(held, "its stream ends")) << "it has ended";
  close(held);

  // Sessions that are left open lock nobody out, and a stop needs none.
  session = begin();
  for (int others = 0; others < 12; ++others)
    begin();
  EXPECT_TRUE(http(port, session, R"({"id":4,"method":"ping"})").starts_with("HTTP/1.1 404"));
  EXPECT_EQ(message_of(http(port, session,
                            R"({"id":4,"method":"tools/call","params":{"name":"emergency_stop"}})"))
                ["result"]["structuredContent"]["latched"],
            true);
  EXPECT_TRUE(http(port, post, R"({"id":4,"method":"tools/call","params":{"name":"robot_status"}})")
                  .starts_with("HTTP/1.1 400"));
  EXPECT_EQ(system.truth().contacts, 0);
}

}  // namespace
}  // namespace saphira::test
