#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace saphira::mcp {

using Json = nlohmann::json;

/// A tool for the language model.
struct Tool {
  std::string name;         ///< [a-zA-Z0-9_-]{1,64}
  std::string description;  ///< for the model
  Json input;               ///< JSON Schema of its arguments: an object
  bool reads = false;       ///< changes nothing; without arguments it is a resource as well
  bool always = false;      ///< exempt from the limit: it stops the robot
  Json output = nullptr;    ///< JSON Schema of Result.value, an object; null: not declared
  bool lasts = false;       ///< asks for a goal: a task for a client that knows tasks
  bool apart = false;       ///< listed and called by the tool kOthers alone
  bool operator==(const Tool&) const = default;
};

/// A call of a tool, with arguments that fit its schema.
struct Call {
  std::uint64_t number = 0;  ///< of this session
  std::string tool;
  Json arguments;
  bool as_task = false;        ///< its answer is a task, at once
  bool as_text = false;        ///< of a resource: its answer is a text, without a picture
  std::uint64_t question = 0;  ///< it repeats a call, with the person's answer to this; 0: none
};

struct Result {
  std::string text;       ///< for the model
  Json value;             ///< the same for programs: an object that fits Tool.output, or null
  bool is_error = false;  ///< the request failed; the text gives the reason and advice
  std::string jpeg = {};  ///< a picture for the model, in base64; empty: none
};

/// The end of a call, for the log.
struct Outcome {
  std::string tool;
  std::string text;  ///< as the client gets it
  bool is_error = false;
};

/// A message for the client.
struct Line {
  std::string text;
  std::uint64_t exchange = 0;  ///< of the request that it belongs to [0: none]
  bool last = false;           ///< it answers that request
  int status = 200;            ///< of HTTP, where it is the whole answer
};

/// The headers of HTTP that repeat a part of the message.
struct Headers {
  std::string version;  ///< MCP-Protocol-Version [empty: not given]
  std::string method;   ///< Mcp-Method
  std::string name;     ///< Mcp-Name
};

/// The client of a message of HTTP, as far as the message identifies it.
struct Sender {
  bool begins = false;   ///< it is `initialize`
  bool modern = false;   ///< the newer era, without sessions
  bool answers = false;  ///< it is the answer to a ping
  std::string client;    ///< identity from the newer era's client, as JSON
  std::string name;      ///< of the client's program, on one line [empty: not given]
  std::string tool;      ///< that it calls [empty: none]
  bool operator==(const Sender&) const = default;
};
Sender sender_of(std::string_view message);

/// The server's side of the Model Context Protocol, for one client. Two eras, which a client may
/// mix: the revisions 2024-11-05 to 2025-11-25, which begin with `initialize`, and 2026-07-28,
/// where each request gives its version. Pure: messages in, messages and calls out. A faulty
/// message gets an error and ends nothing.
class Session {
 public:
  /// name, version: of the server. instructions: the server's description for the model.
  Session(std::string name, std::string version, std::string instructions)
      : name_(std::move(name)),
        version_(std::move(version)),
        instructions_(std::move(instructions)) {}

  /// The tools from now on. Who listens is notified of a change, at most once a second.
  void set_tools(std::vector<Tool> tools);
  const std::vector<Tool>& tools() const { return tools_; }
  /// True: the tools are not all known yet. Lists, readings and calls are held back until false,
  /// except for calls of tools that are always allowed.
  void wait_for_tools(bool waits);
  /// The client sends no more: a call for a goal or an action is refused. True where requests are
  /// still unanswered.
  bool leave();
  /// The time, of any origin, and since 1970 [s]. Watched resources are read again, once a second,
  /// by calls of their tools. Call at least some times a second.
  void turn(double time, double date = 0.0);

  /// A message of the client. exchange: its HTTP request [0: a line of a stream]; headers: of that
  /// request. False: the message gets no answer.
  bool take(std::string_view message, std::uint64_t exchange = 0, const Headers* headers = nullptr);
  /// The client has closed the connection of a request. In the newer era that cancels the request.
  void close(std::uint64_t exchange);
  /// Asks the client for a sign, outside of an answer. For the older era.
  void ping();
  /// Has the client ask its person for a yes or no (elicitation), for a call [0: none is open]. In
  /// the newer era that answers the call, or is a state of its task. Returns the number of the
  /// question; 0: the client cannot.
  std::uint64_t ask_person(const std::string& question, std::uint64_t call);
  /// The question needs no answer any more.
  void take_back(std::uint64_t question);
  /// The client of the newer era repeats its call when its person has answered, and is silent
  /// until then.
  bool is_silent_for(std::uint64_t question) const;
  /// The call has no answer yet.
  bool is_open(std::uint64_t call) const { return open_.contains(call); }
  /// The answers since the last call, by the question. A dismissed question is a no.
  std::vector<std::pair<std::uint64_t, bool>> take_consents();
  /// The server ends: so does each request that listens.
  void end();

  /// Since the last call: called tools, and calls that the client has given up. The latter get no
  /// further answer, except for tasks: those are answered when the robot stands.
  std::vector<Call> take_calls();
  std::vector<std::uint64_t> take_given_up();

  void answer(std::uint64_t call, const Result& result);
  /// Answers a call with a task, of this id and message. Its progress and its answer are the task's
  /// from now on.
  void begin_task(std::uint64_t call, const std::string& id, const std::string& text);
  /// The progress of a call, for a client that asked for it. value has to rise.
  void progress(std::uint64_t call, double value, const std::string& text);

  /// The calls that have ended since the last call; at most kMostOpen of them.
  std::vector<Outcome> take_outcomes();
  /// Messages for the client since the last call.
  std::vector<Line> take_lines();

  static constexpr std::size_t kLongestLine = 1024 * 1024;
  static constexpr std::size_t kLongestArguments = 65536;  ///< of a call, as JSON
  static constexpr std::size_t kMostOpen = 64;             ///< calls without an answer
  static constexpr double kMostASecond = 5.0;              ///< calls, over some seconds
  static constexpr double kMostAtOnce = 20.0;              ///< calls, after a silence
  /// The tool that lists the tools that are apart, and calls them; there where any is.
  static constexpr const char* kOthers = "activity";
  static constexpr const char* kLegacy = "2025-11-25";  ///< the newest revision with `initialize`
  static constexpr const char* kModern = "2026-07-28";

 private:
  /// The part of a request that its answer needs.
  struct Request {
    Json id;
    std::uint64_t exchange = 0;
    bool modern = false;
    std::uint64_t batch = 0;  ///< the batch that it came in [0: none]
    bool elicits = false;     ///< its client can ask its person
  };
  /// To the person at the client, without an answer yet.
  struct Question {
    Json request;           ///< elicitation/create
    std::string tool = {};  ///< whose call is repeated with the answer; empty: none
    std::string task = {};  ///< that waits for the answer; empty: none
  };
  /// Requests that came in one message, and are answered in one.
  struct Batch {
    std::size_t waits = 0;  ///< messages without an answer yet
    Json answers = Json::array();
  };
  /// A request that is held back until the tools are known.
  struct Held {
    std::string method;
    Request request;
    Json parameters;
  };
  struct Open {
    Request request;
    std::string tool;
    Json token;             ///< of progress; null: none is wanted
    Json uri = {};          ///< of the resource that is read; null: a tool was called
    bool watches = false;   ///< it is read for those who listen; the client has not called
    std::string task = {};  ///< the call is this task
  };
  /// Changes that a client wants to hear of.
  struct Listener {
    Request request;  ///< of the older era, which has one listener: without an id
    bool tools = false;
    std::set<std::string> resources = {};
    std::set<std::string> tasks = {};
  };
  /// A resource that somebody listens to.
  struct Watched {
    std::optional<std::string> text = std::nullopt;  ///< as read last
    bool is_read = false;                            ///< now
    /// [s] then it is read again
    double next = -std::numeric_limits<double>::infinity();
  };
  struct Task {
    Json state;              ///< as the client gets it
    std::uint64_t call = 0;  ///< 0: it has ended
    double begun = 0.0;      ///< [s]
    bool withdrawn = false;  ///< by the client
  };
  void send(const Json& message, std::uint64_t exchange, bool last = false, int status = 200) {
    lines_.push_back(
        {message.dump(-1, ' ', false, Json::error_handler_t::replace), exchange, last, status});
  }
  bool take_batch(const Json& messages, std::uint64_t exchange, const Headers* headers);
  bool take_message(const Json& message, Request request, const Headers* headers);
  void respond(const Request& request, Json message, int status);
  void settle(std::uint64_t batch, std::uint64_t exchange);
  void reply(const Request& request, Json result);
  void error(const Request& request, int code, const std::string& text, Json data = nullptr);
  void ask(const std::string& method, const Request& request, const Json& parameters);
  void ask_either(const std::string& method, const Request& request, const Json& parameters);
  void ask_modern(const std::string& method, Request request, const Json& parameters);
  bool fits(const std::string& method, const Request& request, const Json& parameters,
            const Headers& headers);
  bool has_to_wait(const std::string& method, const Json& parameters) const;
  void hold(const std::string& method, const Request& request, const Json& parameters);
  void list_tools(const Request& request);
  Json capabilities(bool modern) const;
  void list_resources(const Request& request);
  const Tool* resource(const Json& uri) const;
  void no_resource(const Request& request, const Json& uri);
  void read(const Request& request, const Json& parameters);
  Listener& older();
  void listen(const Request& request, const Json& parameters);
  void subscribe(const Request& request, const Json& uri, bool wanted);
  void tell(const Listener& listener, const std::string& method, Json parameters);
  void tell_tools();
  void watch(const std::string& uri);
  void see(const std::string& uri, const std::string& text);
  static bool has_tasks(const Json& parameters);
  bool lacks_tasks(const Request& request, const Json& parameters);
  void forget_tasks();
  void ask_task(const std::string& method, const Request& request, const Json& parameters);
  void change_task(const std::string& id, const std::string& status, const std::string& text);
  void end_task(const std::string& id, Json json, const Result& result);
  bool structures(const Request& request) const;
  void list(const Request& request, Json result);
  void call(const Request& request, const Json& parameters, const Json& uri = nullptr);
  Result others() const;
  double too_soon();
  void give_up(const Json& parameters, std::uint64_t exchange);
  static std::uint64_t question_of(const Json& name);
  void take_answer(const Json& message);
  bool take_response(std::uint64_t question, const Json& response);
  void require(const Request& request, std::uint64_t question);
  void erase(std::uint64_t call);
  void note(const std::string& tool, const std::string& text, bool is_error);

  const std::string name_;
  const std::string version_;
  const std::string instructions_;
  std::vector<Tool> tools_;
  std::string revision_ = kLegacy;
  bool waits_ = false;      ///< for the tools
  bool left_ = false;       ///< the client sends no more
  std::vector<Held> held_;  ///< meanwhile, oldest first
  std::uint64_t count_ = 0;
  std::uint64_t pings_ = 0;
  bool elicits_ = false;  ///< the client of the older era can ask its person
  std::uint64_t questions_ = 0;
  std::map<std::uint64_t, Question> asked_;  ///< by number
  std::vector<std::pair<std::uint64_t, bool>> consents_;
  std::map<std::uint64_t, Open> open_;
  std::map<std::uint64_t, Batch> batches_;
  std::uint64_t batch_count_ = 0;
  std::vector<Listener> listeners_;
  std::map<std::string, Watched> watched_;  ///< by uri
  std::map<std::string, Task> tasks_;       ///< by id
  bool news_ = false;                       ///< the tools have changed, and nobody was told
  double told_ = -std::numeric_limits<double>::infinity();  ///< [s] of the tools
  std::vector<Call> calls_;
  std::vector<std::uint64_t> given_up_;
  std::vector<Outcome> outcomes_;
  std::vector<Line> lines_;
  double time_ = 0.0;
  double date_ = 0.0;
  double allowed_ = kMostAtOnce;  ///< calls allowed at once
  double counted_ = 0.0;          ///< [s] time of `allowed_`
};

/// Removes optional arguments that are null.
void drop_nulls(Json& arguments, const Json& schema);
/// The reason why arguments do not fit a schema, in words, with the argument's name; empty where
/// they do. Of JSON Schema: type, properties, required, additionalProperties, items, anyOf, enum,
/// minimum, maximum.
std::string misfit(const Json& arguments, const Json& schema);

}  // namespace saphira::mcp
