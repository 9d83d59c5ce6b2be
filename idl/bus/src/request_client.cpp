#include "saphira/bus/request_client.hpp"

#include <atomic>
#include <chrono>
#include <memory>
#include <utility>

#include "saphira/base/format.hpp"

namespace saphira::bus {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kAgain = 0.3;  // [s] period of repetition
constexpr std::chrono::milliseconds kPollPeriod{50};
constexpr std::chrono::microseconds kSpin{1000};  // most answers are there by then

double seconds() {
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
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

RequestClient::Pending& RequestClient::begin(v1::Request request, Hear hear, double first,
                                             double next) {
  request.asker = node_.instance();
  request.number = next_request_number();
  if (request.source.empty())
    request.source = source_;
  if (pending_.empty())
    matched_ = writer_.matched();
  const v1::Answer lost{.asker = request.asker,
                        .number = request.number,
                        .code = v1::ANSWER_NOBODY,
                        .text = std::string("no program serves requests on ") + topic_.name};
  const std::uint64_t number = request.number;
  return pending_[number] = {std::move(request), std::move(hear), first, next, lost};
}

bool RequestClient::write(Pending& one) {
  const bool written = writer_.write(one.request);
  if (writer_.matched() > 0) {
    if (written)
      one.again.reset();
    one.lost.code = v1::ANSWER_TOO_LATE;
    one.lost.text =
        format("nothing was heard of the request on %s within %.0f s", topic_.name, one.first);
  }
  return written;
}

std::uint64_t RequestClient::send(v1::Request request, Hear hear, double first, double next) {
  Pending& one = begin(std::move(request), std::move(hear), first, next);
  write(one);
  return one.request.number;
}

void RequestClient::withdraw(std::uint64_t number) {
  const auto found = pending_.find(number);
  if (found == pending_.end())
    return;
  Pending& one = found->second;
  one.request.functor = kWithdraw;
  one.request.arguments.clear();
  one.heard = false;
  one.again = 0.0;
  write(one);
}

/// True where a request was written.
bool RequestClient::turn(double now) {
  std::vector<std::pair<Hear, v1::Answer>> heard;
  for (auto& sample : reader_.take()) {
    v1::Answer& answer = sample.data;
    const auto found = pending_.find(answer.number);
    if (sample.info.disposed || answer.asker != node_.instance() || found == pending_.end())
      continue;
    Pending& one = found->second;
    if (one.each) {
      one.each->told.insert(sample.info.writer);
      if (one.each->ended.contains(sample.info.writer))
        continue;
      if (ended(answer.code))
        one.each->ended.insert(sample.info.writer);
    }
    one.heard = true;
    if (one.request.deadline <= 0.0)
      one.end = now + one.next;
    one.lost = answer;
    one.lost.code = v1::ANSWER_TOO_LATE;
    one.lost.text = "the request is still under way";
    heard.emplace_back(one.hear, std::move(answer));
    if (ended(heard.back().second.code) && !one.each)
      pending_.erase(found);
  }
  for (const WriterId& lost : reader_.take_lost())
    for (auto& [number, one] : pending_)
      if (one.each) {
        one.each->told.erase(lost);
        one.each->ended.erase(lost);
      }
  bool wrote = false;
  if (!pending_.empty()) {
    // A program that was started again has to hear the requests anew.
    const std::size_t before = std::exchange(matched_, writer_.matched());
    for (auto& [number, one] : pending_) {
      if (one.each)
        one.heard = one.each->heard();
      if (matched_ < before && one.heard) {
        one.heard = false;
        one.again = now;
      }
      if (!one.end)
        one.end = now + one.first;
      if (now >= *one.end)
        heard.emplace_back(one.hear, one.lost);
      else if (!one.heard && one.again && now >= *one.again && matched_ > 0)
        wrote = write(one) || wrote;
      if (!one.again)
        one.again = now + kAgain;
    }
    std::erase_if(pending_, [now](const auto& item) {
      const Pending& one = item.second;
      return now >= *one.end || (one.each && one.each->over());
    });
  }
  for (const auto& [hear, answer] : heard)
    if (hear)
      hear(answer);
  return wrote;
}

/// A good end of the request, straight from the agent that carried it out. Any other answer is for
/// the router to judge: it may ask another agent, or wait for more answers. On a secured bus the
/// router alone knows who speaks for an agent.
std::optional<v1::Answer> RequestClient::take_direct(const v1::Request& request) {
  if (!direct_)
    return std::nullopt;
  std::optional<v1::Answer> end;
  for (auto& sample : direct_->take()) {
    v1::Answer& answer = sample.data;
    if (sample.info.disposed || sample.info.sender || answer.asker != request.asker ||
        answer.number != request.number || !ended(answer.code) || !well(answer.code))
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
                              const std::function<void()>& meanwhile, Hear hear) {
  std::optional<v1::Answer> end;
  const auto listen = [&](const v1::Answer& answer) {
    if (ended(answer.code))
      end = answer;
    else if (hear)
      hear(answer);
  };
  Pending& one = begin(std::move(request), listen, patience, patience);
  const std::shared_ptr<void> forgets(
      nullptr, [this, number = one.request.number](void*) { pending_.erase(number); });
  while (true) {
    if (turn(seconds()))
      node_.spin(kSpin);
    if (end)
      return *std::move(end);
    if (stop != nullptr && stop->requested())
      return one.lost;
    node_.wait(kPollPeriod, stop);
    if (meanwhile)
      meanwhile();
    if (auto answer = end ? std::nullopt : take_direct(one.request))
      return *std::move(answer);
  }
}

std::vector<v1::Answer> RequestClient::ask_each(v1::Request request, double patience,
                                                Servers servers, const Stop* stop,
                                                const std::function<void()>& meanwhile, Hear hear) {
  std::vector<v1::Answer> ends;
  const auto listen = [&](const v1::Answer& answer) {
    if (ended(answer.code))
      ends.push_back(answer);
    if (hear)
      hear(answer);
  };
  Pending& one = begin(std::move(request), listen, patience, patience);
  one.each = {std::move(servers), {}, {}};
  const std::uint64_t number = one.request.number;
  const std::shared_ptr<void> forgets(nullptr, [this, number](void*) { pending_.erase(number); });
  while (true) {
    turn(seconds());
    if (!pending_.contains(number))
      return ends;
    if (stop != nullptr && stop->requested()) {
      ends.push_back(one.lost);
      return ends;
    }
    node_.wait(kPollPeriod, stop);
    if (meanwhile)
      meanwhile();
  }
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
