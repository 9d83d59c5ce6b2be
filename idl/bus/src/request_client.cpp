#include "saphira/bus/request_client.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "saphira/base/format.hpp"

namespace saphira::bus {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kAgain{300};  // period of repetition
constexpr std::chrono::milliseconds kLook{50};
constexpr std::chrono::microseconds kSpin{1000};  // most answers are there by then

std::string seconds(double patience) {
  return format("%.0f s", patience);
}

}  // namespace

RequestClient::RequestClient(Node& node, const RequestTopic& topic, std::string source,
                             const Topic<v1::Answer>* direct)
    : node_(node),
      topic_(topic),
      source_(std::move(source)),
      writer_(node.writer<v1::Request>(topic)),
      reader_(node.reader(topic.answers)) {
  if (direct != nullptr)
    direct_ = node.reader(*direct);
}

v1::Request RequestClient::complete(v1::Request request, std::uint64_t number) {
  request.asker = node_.instance();
  request.number = number;
  if (request.source.empty())
    request.source = source_;
  return request;
}

std::uint64_t RequestClient::send(v1::Request request) {
  request = complete(std::move(request), next_request_number());
  if (!writer_.write(request))
    throw std::runtime_error(std::string("the bus did not take a request on ") + topic_.name);
  return request.number;
}

void RequestClient::again(std::uint64_t number, v1::Request request) {
  writer_.write(complete(std::move(request), number));
}

std::vector<v1::Answer> RequestClient::poll() {
  std::vector<v1::Answer> answers;
  for (auto& sample : reader_.take())
    if (!sample.info.disposed && sample.data.asker == node_.instance())
      answers.push_back(std::move(sample.data));
  return answers;
}

/// A good end of the request, straight from the agent that carried it out. Any other answer is for
/// the router to judge: it may ask another agent, or wait for more answers.
std::optional<v1::Answer> RequestClient::take_direct(const v1::Request& request) {
  if (!direct_)
    return std::nullopt;
  std::optional<v1::Answer> end;
  for (auto& sample : direct_->take()) {
    v1::Answer& answer = sample.data;
    if (sample.info.disposed || answer.asker != request.asker || answer.number != request.number ||
        !ended(answer.code) || !well(answer.code))
      continue;
    answer.service = answer.service.substr(answer.service.find('/') + 1);  // of agent_address()
    end = std::move(answer);
  }
  const auto& arguments = request.arguments;
  const bool several = std::any_of(arguments.begin(), arguments.end(),
                                   [](const v1::Argument& one) { return one.name == "answers"; });
  return several ? std::nullopt : end;
}

v1::Answer RequestClient::ask(v1::Request request, double patience, const Stop* stop,
                              const std::function<void()>& meanwhile) {
  request = complete(std::move(request), next_request_number());
  v1::Answer newest{.asker = request.asker,
                    .number = request.number,
                    .code = v1::ANSWER_NOBODY,
                    .text = std::string("no program takes what is asked on ") + topic_.name};
  bool heard = false;
  std::size_t matched = writer_.matched();
  auto again = Clock::now();
  const auto limit =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(patience));
  auto end = again + limit;
  for (auto now = again; now < end && (stop == nullptr || !stop->requested()); now = Clock::now()) {
    // A program that was started again has to hear the request anew.
    if (const std::size_t before = std::exchange(matched, writer_.matched()); matched < before) {
      heard = false;
      again = now;
    }
    if (!heard && now >= again && matched > 0 && writer_.write(request)) {
      again = now + kAgain;
      newest.code = v1::ANSWER_TOO_LATE;
      newest.text = "nothing was heard of the request within " + seconds(patience);
      node_.spin(kSpin);
    }
    node_.wait(std::min(kLook, std::chrono::ceil<std::chrono::milliseconds>(end - now)), stop);
    if (meanwhile)
      meanwhile();
    if (auto answer = take_direct(request))
      return *std::move(answer);
    for (v1::Answer& answer : poll()) {
      if (answer.number != request.number)
        continue;
      heard = true;
      newest = std::move(answer);
      if (ended(newest.code))
        return newest;
      if (request.deadline <= 0.0)
        end = Clock::now() + limit;
    }
  }
  if (!ended(newest.code)) {
    newest.code = v1::ANSWER_TOO_LATE;
    newest.text = "the request is still under way";
  }
  return newest;
}

v1::Request request(const std::string& functor, std::vector<v1::Argument> arguments,
                    const std::string& service) {
  v1::Request made{.functor = functor, .arguments = std::move(arguments)};
  made.service = service;
  return made;
}

v1::Argument number(const std::string& name, double value) {
  return {.name = name, .kind = v1::ARGUMENT_NUMBER, .number = value};
}

v1::Argument text(const std::string& name, const std::string& value) {
  return {.name = name, .kind = v1::ARGUMENT_TEXT, .text = value};
}

v1::Argument point(const std::string& name, double x, double y, double th, v1::Frame frame) {
  return {.name = name, .kind = v1::ARGUMENT_POINT, .point = {x, y, th}, .frame = frame};
}

v1::Argument truth(const std::string& name, bool value) {
  v1::Argument argument = number(name, value ? 1.0 : 0.0);
  argument.kind = v1::ARGUMENT_TRUTH;
  return argument;
}

std::uint64_t next_request_number() {
  static std::atomic<std::uint64_t> number{0};
  return ++number;
}

bool ended(v1::AnswerCode code) {
  return code != v1::ANSWER_UNDERWAY;
}

bool well(v1::AnswerCode code) {
  return code == v1::ANSWER_UNDERWAY || code == v1::ANSWER_DONE || code == v1::ANSWER_SENT;
}

}  // namespace saphira::bus
