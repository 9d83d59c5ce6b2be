#include "requests/shell/desk.hpp"

#include <algorithm>
#include <string_view>
#include <tuple>

#include "requests/shell/convert.hpp"
#include "saphira/bus/sender.hpp"

namespace saphira {
namespace {

constexpr std::size_t kKnown = 256;  // requests whose repetition is recognized

}  // namespace

Desk::Desk(bus::Node& node, const bus::Topic<v1::Answer>& answers)
    : node_(node), writer_(node.writer(answers)) {
  // The bridge, which keeps the audit, decides itself what it enters of its own requests.
  if (std::string_view(answers.name) != bus::topics::kRobotAnswers.name)
    audit_.emplace(node);
}

void Desk::serve(const bus::RequestTopic& topic, std::vector<Functor> functors, Act act) {
  counters_.push_back(std::make_unique<Counter>(
      Counter{node_.reader<v1::Request>(topic), std::move(functors), std::move(act)}));
}

void Desk::take(const v1::Stamp& now) {
  now_ = now;
  for (const auto& counter : counters_)
    take(*counter);
}

void Desk::take(Counter& counter) {
  // Mostly nobody has a request. The last requests of a program that has just left are still read.
  const bool asks = counter.reader.matched() > 0;
  const bool asked = std::exchange(counter.asked, asks);
  if (!asks && !asked && counter.waiting.empty())
    return;
  for (auto& sample : counter.reader.take())
    if (!sample.info.disposed &&
        (sample.data.service.empty() || sample.data.service == node_.options().name))
      counter.waiting.push_back(from_bus(sample));
  const auto later = std::stable_partition(
      counter.waiting.begin(), counter.waiting.end(),
      [&](const Request& one) { return !node_.options().lockstep || is_due(one, now_); });
  std::vector<Request> due(counter.waiting.begin(), later);
  counter.waiting.erase(counter.waiting.begin(), later);
  if (node_.options().lockstep)  // requests of several services, in the same order in every run
    std::stable_sort(due.begin(), due.end(), [](const Request& a, const Request& b) {
      return std::tie(a.stamp.cycle, a.source) < std::tie(b.stamp.cycle, b.source);
    });
  for (Request& request : due)
    handle(counter, std::move(request));
}

void Desk::handle(const Counter& counter, Request request) {
  const Id id{request.asker, request.number};
  const auto known =
      std::find_if(known_.begin(), known_.end(), [&](const auto& one) { return one.first == id; });
  if (id.second != 0 && known != known_.end()) {
    if (known->second)
      writer_.write(*known->second);
    return;
  }
  known_.emplace_back(id, std::nullopt);
  if (known_.size() > kKnown)
    known_.pop_front();

  std::optional<Answer> done = refusal(counter.functors, request);
  if (!done)
    done = counter.act(request);
  const bool refuses = done && !well(done->code);
  const bool is_own =
      request.person && (request.person->role == "services" || request.person->role == "robot");
  if (audit_ && !is_own)
    audit_->write({.act = refuses ? v1::AUDIT_REFUSED : v1::AUDIT_ASKED,
                   .who = request.source,
                   .text = describe(request) + (refuses ? ": " + done->text : "")});
  if (refuses) {
    ++refused_;
    node_.warn("a request of " + request.source + ": " + done->text);
  } else {
    node_.info(describe(request) + ", asked for by " + request.source);
  }
  if (done)
    answer(id.first, id.second, *done);
}

void Desk::answer(std::uint64_t asker, std::uint64_t number, const Answer& answer) {
  v1::Answer sample = to_bus(answer);
  sample.stamp = now_;
  sample.asker = asker;
  sample.number = number;
  sample.service = node_.options().name;
  writer_.write(sample);
  for (auto& [id, newest] : known_)
    if (id == Id{asker, number})
      newest = sample;
}

}  // namespace saphira
