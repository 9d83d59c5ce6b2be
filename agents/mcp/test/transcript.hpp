#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <deque>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "client.hpp"
#include "lines.hpp"

namespace saphira::mcp::test {

/// A conversation of a client with a session, line by line:
/// `> ID METHOD PARAMETERS` is sent; an id that begins with a letter is of the newer era, `-` is a
///   notification, `ID@N` comes in the exchange N, and the method `call` is that of a tool. `>>` or
///   `>>@N` is sent as it stands.
/// `< ID = RESULT`, `< ID ! CODE ERROR`, `< ID says TEXT`, `< ID fails TEXT` or `< MESSAGE` is the
///   next message for the client. Each written member has to be in it, null is absent, "~text" is a
///   part, "$name" stands for a value (the first time it is any), {"=":OBJECT} has no other
///   members, and `==` is the whole result. Before it: `@N` its exchange, `last` or `more` of that,
///   `httpN` its status. Without an id it answers the line before. `< ...` is all that has come. `<
///   call N` is the next call.
/// `fact: value` holds, and each other line is an event. ` => ` parts two of them in one line, the
///   second without its `<`.
/// A message or a call that is not written is a failure.
class Transcript {
 public:
  explicit Transcript(Session& session) : session_(session) {}
  virtual ~Transcript() = default;

  void take(const std::string& whole) {
    const std::size_t arrow = whole.find(" => ");
    take_one(whole.substr(0, arrow));
    if (arrow != std::string::npos)
      take_one("< " + whole.substr(arrow + 4));
  }
  /// Nothing has come that is not written.
  virtual void finish() {
    for (const Line& each : std::exchange(heard_, {}))
      ADD_FAILURE() << "not written before this: " << each.text;
    for (const Call& call : std::exchange(calls_, {}))
      ADD_FAILURE() << "not written before this: the call of " << call.tool;
  }

 protected:
  using Event = std::function<void(std::istringstream&)>;
  using Fact = std::function<std::string()>;

  /// The robot's side, after each event: the calls that the test itself answers.
  virtual std::vector<Call> turn() = 0;
  static std::string rest(std::istringstream& in) {
    std::string text;
    std::getline(in >> std::ws, text);
    return text;
  }
  /// With the values of the names in it.
  std::string filled(std::string text) const {
    for (const auto& [name, value] : names_)
      for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += value.size())
        text.replace(at, name.size(), value);
    return text;
  }
  static std::string yes(bool is) { return is ? "yes" : "no"; }

  std::map<std::string, Event> events_{
      {"can", [this](auto& in) { capabilities_ = Json::parse(rest(in)); }},
      {"headers", [this](auto& in) {
         Headers& given = headers_.emplace();
         for (std::string* each : {&given.version, &given.method, &given.name})
           if (in >> *each && *each == "-")
             each->clear();
       }}};
  std::map<std::string, Fact> facts_{{"takes", [this] { return yes(takes_); }},
                                     {"call", [this] { return called(); }}};
  std::map<std::string, std::string> names_;
  Json message_;  ///< compared last

 private:
  void take_one(const std::string& line) {
    std::istringstream in(line.substr(std::min(line.size(), line.find(' '))));
    const std::string verb = line.substr(0, line.find(' '));
    const std::string name = line.substr(0, line.find(':'));
    if (verb == "<")
      return expect(in);
    if (const auto fact = facts_.find(name); fact != facts_.end() && name.size() < line.size()) {
      const std::string wanted = filled(line.substr(std::min(line.size(), name.size() + 2)));
      EXPECT_EQ(fact->second(), wanted);
      return;
    }
    finish();
    if (verb == ">")
      send(message(in));
    else if (verb.starts_with(">>")) {
      exchange_ = verb.size() > 3 ? std::stoull(verb.substr(3)) : 0;
      send(filled(rest(in)));
    } else if (const auto event = events_.find(verb); event != events_.end())
      event->second(in);
    else
      ADD_FAILURE() << "not understood: " << line;
    for (Call& call : turn())
      calls_.push_back(std::move(call));
    for (Line& said : session_.take_lines())
      heard_.push_back(std::move(said));
  }
  static Json id_of(const std::string& text) {
    return std::isdigit(static_cast<unsigned char>(text[0])) != 0 ? Json(std::stoi(text))
                                                                  : Json(text);
  }
  void send(const std::string& text) {
    takes_ = session_.take(text, std::exchange(exchange_, 0), headers_ ? &*headers_ : nullptr);
    headers_.reset();
  }
  std::string message(std::istringstream& in) {
    std::string method;
    in >> id_ >> method;
    Json parameters = Json::object();
    if (method == "call") {
      method = "tools/call";
      std::string tool;
      in >> tool;
      parameters["name"] = tool;
      const std::string arguments = filled(rest(in));
      parameters["arguments"] = arguments.empty() ? Json::object() : Json::parse(arguments);
    } else if (const std::string given = filled(rest(in)); !given.empty()) {
      parameters = Json::parse(given);
    }
    if (const std::size_t at = id_.find('@'); at != std::string::npos) {
      exchange_ = std::stoull(id_.substr(at + 1));
      id_.resize(at);
    }
    Json all{{"jsonrpc", "2.0"}, {"method", method}};
    if (id_ != "-")
      all["id"] = id_of(id_);
    if (all.contains("id") && all["id"].is_string()) {
      Json meta{{"io.modelcontextprotocol/protocolVersion", Session::kModern},
                {"io.modelcontextprotocol/clientCapabilities", capabilities_}};
      meta.update(parameters.value("_meta", Json::object()));
      parameters["_meta"] = meta;
    }
    all["params"] = parameters;
    return all.dump();
  }

  std::string called() {
    if (calls_.empty())
      return "none";
    const Call call = calls_.front();
    calls_.pop_front();
    return std::to_string(call.number) + (call.as_task ? " as task" : "") +
           (call.question == 0 ? "" : " on question " + std::to_string(call.question)) + " " +
           call.tool + " " + call.arguments.dump();
  }

  void expect(std::istringstream& in) {
    std::string word;
    in >> word;
    if (word == "call") {
      const std::string call = called();
      EXPECT_TRUE((call + " ").starts_with(rest(in) + " ")) << call;
      return;
    }
    if (word == "...")
      return heard_.clear();
    if (heard_.empty()) {
      ADD_FAILURE() << "nothing more has come";
      return;
    }
    const Line said = heard_.front();
    heard_.pop_front();
    SCOPED_TRACE(said.text);
    message_ = Json::parse(said.text);
    for (;; in >> word) {
      if (word[0] == '@')
        EXPECT_EQ(said.exchange, std::stoull(word.substr(1)));
      else if (word == "last" || word == "more")
        EXPECT_EQ(said.last, word == "last");
      else if (word.starts_with("http"))
        EXPECT_EQ(said.status, std::stoi(word.substr(4)));
      else
        break;
    }
    if (word[0] == '{' || word[0] == '[')
      return compare(message_, Json::parse(word + std::string(std::istreambuf_iterator(in), {})),
                     "");
    std::string kind = word;
    if (!kOperators.contains(kind))
      in >> kind;
    compare(message_["id"], id_of(kind == word ? id_ : word), "id");
    Json result = message_.value("result", Json());
    const std::string text = kind == "!" ? "" : filled(rest(in));
    int code = 0;
    if (kind == "=") {
      compare(result, Json::parse(text), "result");
    } else if (kind == "==") {
      EXPECT_EQ(result, Json::parse(text));
    } else if (kind == "says" || kind == "fails") {
      compare(result["isError"], kind == "fails", "isError");
      if (!text.empty())
        compare(result["content"][0]["text"], text, "text");
    } else if (kind == "!" && in >> code) {
      compare(message_.value("error", Json())["code"], code, "code");
      if (const std::string more = rest(in); !more.empty())
        compare(message_.value("error", Json()), Json::parse(more), "error");
    } else {
      ADD_FAILURE() << "not understood: " << kind;
    }
  }

  void compare(const Json& is, const Json& wanted, const std::string& where) {
    if (wanted.is_object() && wanted.contains("=")) {
      EXPECT_EQ(is.size(), wanted["="].size()) << where << is;
      compare(is, wanted["="], where);
    } else if (wanted.is_object() && is.is_object()) {
      for (const auto& [key, value] : wanted.items())
        compare(is.contains(key) ? is[key] : Json(), value, where + "/" + key);
    } else if (wanted.is_array() && is.is_array() && wanted.size() == is.size()) {
      for (std::size_t i = 0; i < is.size(); ++i)
        compare(is[i], wanted[i], where + "/" + std::to_string(i));
    } else if (const std::string text = wanted.is_string() ? wanted.get<std::string>() : "";
               text.starts_with("$") && is.is_string()) {
      EXPECT_EQ(names_.try_emplace(text, is).first->second, is) << where;
    } else if (text.starts_with("~") && is.is_string()) {
      EXPECT_NE(is.get<std::string>().find(text.substr(1)), std::string::npos) << where << is;
    } else {
      EXPECT_EQ(is, wanted) << where;
    }
  }

  inline static const std::set<std::string> kOperators{"=", "==", "!", "says", "fails"};
  Session& session_;
  std::deque<Line> heard_;
  std::deque<Call> calls_;  ///< that the test answers
  std::string id_;          ///< sent last
  std::optional<Headers> headers_;
  std::uint64_t exchange_ = 0;
  bool takes_ = false;
  Json capabilities_ = Json::object();
};

}  // namespace saphira::mcp::test
