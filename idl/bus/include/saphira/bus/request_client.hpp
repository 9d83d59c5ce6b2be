#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "saphira/base/withdraw.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bus {

/// An agent's side of requests: asks, and waits for the answers. For the node's own thread.
///
///   Node node(options);
///   RequestClient robot(node, topics::kServo, "my agent");
///   v1::Request request;
///   request.functor("servo");
///   request.arguments({number("width", 1500)});
///   const v1::Answer answer = robot.ask(request, 10.0);
///   if (answer.code() != v1::ANSWER_DONE) ... answer.text() ...
class RequestClient {
 public:
  /// source: name of the asker, for people. direct: topic of the answers before a router passes
  /// them on.
  RequestClient(Node& node, const RequestTopic& topic, std::string source,
                const Topic<v1::Answer>* direct = nullptr);

  /// Asks, and waits for the end of the request, for `patience` [s] at most; without a deadline in
  /// the request, for as long after each ANSWER_UNDERWAY. There is always an answer: ANSWER_NOBODY
  /// says that no program takes such requests, and ANSWER_TOO_LATE that none has answered. The
  /// request is written again until a program answers, and when such a program is gone; it is
  /// carried out once.
  /// `meanwhile` is called whenever a sample has come to the node.
  v1::Answer ask(v1::Request request, double patience, const Stop* stop = nullptr,
                 const std::function<void()>& meanwhile = {});

  /// Asks without waiting: the number of the request. Its answers come out of poll().
  std::uint64_t send(v1::Request request);
  /// Writes a request of send() once more, under its number, for a program that has started since.
  /// With the functor kWithdraw: withdraws it.
  void again(std::uint64_t number, v1::Request request);
  /// The answers to this client's requests, since the last call, oldest first.
  std::vector<v1::Answer> poll();

 private:
  v1::Request complete(v1::Request request, std::uint64_t number);
  std::optional<v1::Answer> take_direct(const v1::Request& request);

  Node& node_;
  const RequestTopic topic_;
  std::string source_;
  Writer<v1::Request> writer_;
  Reader<v1::Answer> reader_;
  std::optional<Reader<v1::Answer>> direct_;
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
