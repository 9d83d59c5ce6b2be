#include "requests/shell/desk.hpp"

#include <algorithm>
#include <string_view>
#include <tuple>
#include <utility>

#include "requests/shell/convert.hpp"
#include "saphira/bus/sender.hpp"

namespace saphira {

Desk::Desk(bus::Node& node, const bus::RequestTopic& topic, std::vector<Functor> functors,
           Answers answers)
    : node_(node),
      functors_(std::move(functors)),
      reader_(node.reader<v1::Request>(topic)),
      server_(
          node.options().name, false,
          [to = answers ? answers
                        : std::make_shared<bus::Writer<v1::Answer>>(node.writer(topic.answers))](
              const v1::Answer& one) { to->write(one); },
          [&node](const std::string& text) { node.warn(text); }) {
  // The bridge, which keeps the audit, decides itself what it enters of its own requests.
  if (std::string_view(topic.answers.name) != bus::topics::kRobotAnswers.name)
    audit_.emplace(node);
}

std::vector<Request> Desk::take(const v1::Stamp& now) {
  now_ = now;
  // Mostly nobody has a request. The last requests of a program that has just left are still read.
  const bool asks = reader_.matched() > 0;
  if (std::exchange(asked_, asks) || asks)
    for (const auto& sample : reader_.take())
      if (!sample.info.disposed && server_.hear(sample.data, sample.info.sender.get()))
        waiting_.push_back(from_bus(sample));
  const bool lockstep = node_.options().lockstep;
  const auto later =
      std::stable_partition(waiting_.begin(), waiting_.end(),
                            [&](const Request& one) { return !lockstep || is_due(one, now_); });
  std::vector<Request> due(waiting_.begin(), later);
  waiting_.erase(waiting_.begin(), later);
  if (lockstep)  // requests of several services, in the same order in every run
    std::stable_sort(due.begin(), due.end(), [](const Request& a, const Request& b) {
      return std::tie(a.stamp.cycle, a.source) < std::tie(b.stamp.cycle, b.source);
    });
  std::erase_if(due, [this](Request& request) {
    const auto refused = refusal(functors_, request);
    if (refused)
      answer(request, refused);
    return refused.has_value();
  });
  return due;
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
    answer(request.asker, request.number, *outcome);
}

bool Desk::answer(std::uint64_t asker, std::uint64_t number, const Answer& answer) {
  v1::Answer sample = to_bus(answer);
  sample.stamp = now_;
  return server_.answer(asker, number, std::move(sample));
}

}  // namespace saphira
