#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace saphira::mcp {

using Json = nlohmann::json;

/// Something that a language model may ask for.
struct Tool {
  std::string name;         ///< [a-zA-Z0-9_-]{1,64}
  std::string description;  ///< for the model
  Json input;               ///< JSON Schema of its arguments: an object
  bool reads = false;       ///< changes nothing
  bool operator==(const Tool&) const = default;
};

/// A tool that was called, with arguments that fit its schema.
struct Call {
  std::uint64_t number = 0;  ///< of this session
  std::string tool;
  Json arguments;
};

struct Result {
  std::string text;  ///< for the model
  Json value;        ///< the same for programs: an object, or null
  bool is_error =
      false;  ///< what it asked for was not done; the text says why, and what would help
};

/// The server's side of the Model Context Protocol, over lines of JSON-RPC: the revisions
/// 2024-11-05 to 2025-11-25. Pure: lines in, lines and calls out. A line that is wrong gets an
/// error and ends nothing.
class Session {
 public:
  /// name, version: of the server. instructions: what the model is told of it.
  Session(std::string name, std::string version, std::string instructions)
      : name_(std::move(name)),
        version_(std::move(version)),
        instructions_(std::move(instructions)) {}

  /// What can be asked for from now on. The client is told when it changes.
  void set_tools(std::vector<Tool> tools);
  const std::vector<Tool>& tools() const { return tools_; }

  /// A line of the client, without its end.
  void take(std::string_view line);

  /// Since the last call: tools that were called, and calls that the client has given up. Of those
  /// nothing more is to be answered.
  std::vector<Call> take_calls();
  std::vector<std::uint64_t> take_given_up();

  void answer(std::uint64_t call, const Result& result);
  /// How far a call has come, for a client that asked to be told. value has to rise.
  void progress(std::uint64_t call, double value, const std::string& text);

  /// For the client, since the last call.
  std::vector<std::string> take_lines();

  static constexpr std::size_t kLongestLine = 65536;
  static constexpr std::size_t kMostOpen = 64;  ///< calls that are not answered

 private:
  struct Open {
    Json id;
    Json token;  ///< of progress; null: none is wanted
  };
  void send(const Json& message) {
    lines_.push_back(message.dump(-1, ' ', false, Json::error_handler_t::replace));
  }
  void reply(const Json& id, Json result);
  void error(const Json& id, int code, const std::string& text);
  void request(const std::string& method, const Json& id, const Json& parameters);
  void call(const Json& id, const Json& parameters);
  void give_up(const Json& parameters);

  const std::string name_;
  const std::string version_;
  const std::string instructions_;
  std::vector<Tool> tools_;
  bool begun_ = false;
  std::uint64_t count_ = 0;
  std::map<std::uint64_t, Open> open_;
  std::vector<Call> calls_;
  std::vector<std::uint64_t> given_up_;
  std::vector<std::string> lines_;
};

/// Why arguments do not fit a schema, in words that name the argument; empty where they do. Of JSON
/// Schema: type, properties, required, additionalProperties, enum, minimum, maximum.
std::string misfit(const Json& arguments, const Json& schema);

}  // namespace saphira::mcp
