#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "saphira/base/withdraw.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bus {

/// An agent's side of requests: asks, and hears the answers. For the node's own thread.
///
///   Node node(options);
///   RequestClient robot(node, topics::kServo, "my agent");
///   const v1::Answer answer = robot.ask(request("servo", {number("width", 1500)}), 10.0);
///   if (answer.code != v1::ANSWER_DONE) ... answer.text ...
///
/// A request is written again until a program answers, and when such a program is gone; it is
/// carried out once. Each request has an end. Where no program gives one in time, it is this
/// client's: ANSWER_NOBODY says that no program takes such requests, and ANSWER_TOO_LATE that none
/// has answered.
class RequestClient {
 public:
  /// Called with each answer to a request, the end last.
  using Hear = std::function<void(const v1::Answer&)>;

  /// source: name of the asker, for people. direct: topic of the answers before a router passes
  /// them on.
  RequestClient(Node& node, const RequestTopic& topic, std::string source,
                const Topic<v1::Answer>* direct = nullptr);

  /// Asks, and waits for the end of the request, for `patience` [s] at most; without a deadline in
  /// the request, for as long after each ANSWER_UNDERWAY. `meanwhile` is called whenever a sample
  /// has come to the node; `hear` with each answer before the end.
  v1::Answer ask(v1::Request request, double patience, const Stop* stop = nullptr,
                 const std::function<void()>& meanwhile = {}, Hear hear = {});

  /// The programs that a request is for.
  struct Servers {
    /// True where none of those that are there is missing among these writers of answers.
    std::function<bool(const std::set<WriterId>&)> all_of;
    /// True where no other is on its way.
    std::function<bool()> complete;
  };
  /// Asks several programs, such as the bridges of all robots. Waits until each has come to its
  /// end. `hear` hears all answers, each program's end once. Returns the ends; where `patience` [s]
  /// is over, or at a stop, the last one is this client's.
  std::vector<v1::Answer> ask_each(v1::Request request, double patience, Servers servers,
                                   const Stop* stop = nullptr,
                                   const std::function<void()>& meanwhile = {}, Hear hear = {});

  /// Asks without waiting: the number of the request. Its answers come in poll(). It ends `first`
  /// [s] after the next poll(); without a deadline in the request, `next` [s] after each
  /// ANSWER_UNDERWAY.
  std::uint64_t send(v1::Request request, Hear hear = {}, double first = 10.0, double next = 10.0);
  /// Withdraws a request of send() that has not ended; its end still comes.
  void withdraw(std::uint64_t number);
  /// Hears the answers, and writes the requests that are due. now: [s] of a clock that never goes
  /// back, the steady one where this client waits in ask(), too.
  void poll(double now) { turn(now); }

 private:
  /// For a request to several programs.
  struct Each {
    Servers servers;
    std::set<WriterId> told;   ///< those that have answered
    std::set<WriterId> ended;  ///< of these

    bool heard() const { return !told.empty() && servers.all_of(told); }
    bool over() const { return told.size() == ended.size() && heard() && servers.complete(); }
  };
  /// A request that has not ended.
  struct Pending {
    v1::Request request;
    Hear hear;
    double first = 0.0;
    double next = 0.0;
    v1::Answer lost;                    ///< its end where no further answer comes
    bool heard = false;                 ///< by a program that is still there
    std::optional<double> again = 0.0;  ///< [s] then it is written; none: it was, since poll()
    std::optional<double> end{};        ///< [s] then it is lost; none: it was not polled yet
    std::optional<Each> each{};         ///< none: the first end counts
  };
  Pending& begin(v1::Request request, Hear hear, double first, double next);
  bool write(Pending& one);
  bool turn(double now);
  std::optional<v1::Answer> take_direct(const v1::Request& request);

  Node& node_;
  const RequestTopic topic_;
  std::string source_;
  Writer<v1::Request> writer_;
  Reader<v1::Answer> reader_;
  std::optional<Reader<v1::Answer>> direct_;
  std::map<std::uint64_t, Pending> pending_;  ///< by number
  std::size_t matched_ = 0;                   ///< programs that take requests
};

using saphira::kWithdraw;

v1::Request request(const std::string& functor, std::vector<v1::Argument> arguments = {},
                    const std::string& service = {});
v1::Argument number(const std::string& name, double value);
v1::Argument text(const std::string& name, const std::string& value);
/// x, y [m], th [rad], in the frame.
v1::Argument point(const std::string& name, double x, double y, double th, v1::Frame frame);
v1::Argument truth(const std::string& name, bool value);

/// Counts the requests of this process: each has a number of its own.
std::uint64_t next_request_number();

/// True where a request with this answer has come to its end.
bool ended(v1::AnswerCode code);
/// True where the code is a good end, or may become one.
bool well(v1::AnswerCode code);

}  // namespace saphira::bus
