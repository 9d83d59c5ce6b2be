#include "requests/shell/desk.hpp"

#include <algorithm>
#include <string_view>
#include <tuple>
#include <utility>

#include "requests/shell/convert.hpp"
#include "saphira/bus/sender.hpp"

namespace saphira {

Desk::Desk(bus::Node& node, const bus::Topic<v1::Answer>& answers)
    : node_(node), writer_(node.writer(answers)) {
  // The bridge, which keeps the audit, decides itself what it enters of its own requests.
  if (std::string_view(answers.name) != bus::topics::kRobotAnswers.name)
    audit_.emplace(node);
}

void Desk::serve(const bus::RequestTopic& topic, std::vector<Functor> functors) {
  counters_.push_back(
      std::make_unique<Counter>(Counter{node_.reader<v1::Request>(topic), std::move(functors)}));
}

std::vector<Request> Desk::take(const v1::Stamp& now) {
  now_ = now;
  std::vector<Request> out;
  for (const auto& counter : counters_)
    take(*counter, out);
  return out;
}

void Desk::take(Counter& counter, std::vector<Request>& out) {
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
  for (Request& request : due) {
    const v1::Answer* const known =
        request.number == 0 ? nullptr : counter.known.find(request.asker, request.number);
    if (known != nullptr && !known->service.empty())
      writer_.write(*known);  // it may not have arrived
    if (known != nullptr)
      continue;
    if (const auto refused = refusal(counter.functors, request))
      answer(request, refused);
    else
      out.push_back(std::move(request));
  }
}

void Desk::answer(const Request& request, const std::optional<Answer>& outcome) {
  const bool refuses = outcome && !well(outcome->code);
  const bool is_own =
      request.person && (request.person->role == "services" || request.person->role == "robot");
  if (audit_ && !is_own)
    audit_->write({.act = refuses ? v1::AUDIT_REFUSED : v1::AUDIT_ASKED,
                   .who = request.source,
                   .text = describe(request) + (refuses ? ": " + outcome->text : "")});
  if (refuses) {
    ++refused_;
    node_.warn("a request of " + request.source + ": " + outcome->text);
  } else {
    node_.info(describe(request) + ", asked for by " + request.source);
  }
  if (outcome)
    send(request.asker, request.number, *outcome, request.functor);
}

void Desk::answer(std::uint64_t asker, std::uint64_t number, const Answer& answer) {
  send(asker, number, answer, {});
}

void Desk::send(std::uint64_t asker, std::uint64_t number, const Answer& answer,
                const std::string& functor) {
  v1::Answer sample = to_bus(answer);
  sample.stamp = now_;
  sample.asker = asker;
  sample.number = number;
  sample.service = node_.options().name;
  writer_.write(sample);
  const auto serves = [&functor](const auto& counter) {
    return std::any_of(counter->functors.begin(), counter->functors.end(),
                       [&functor](const Functor& one) { return one.name == functor; });
  };
  const bool served = std::any_of(counters_.begin(), counters_.end(), serves);
  for (const auto& counter : counters_)
    if (!served || serves(counter))
      counter->known.keep(sample);
}

}  // namespace saphira
