#include "saphira/requests/request.hpp"

#include <algorithm>

#include "saphira/base/text.hpp"

namespace saphira {

std::string describe(const Request& request) {
  return request.functor.substr(0, 40) + (request.arguments.empty() ? "" : " ") +
         describe(request.arguments);
}

std::optional<Answer> refusal(const std::vector<Functor>& functors, Request& request) {
  const auto functor = std::find_if(functors.begin(), functors.end(), [&](const Functor& one) {
    return one.name == request.functor;
  });
  if (functor == functors.end()) {
    return Answer{AnswerCode::unknown_functor, "functor " + quoted(request.functor) +
                                                   " is not known here: expected " +
                                                   joined(functors, ", ", &Functor::name)};
  }
  if (const std::string wrong = complete(*functor, request.arguments); !wrong.empty())
    return Answer{AnswerCode::bad_argument, wrong};
  return std::nullopt;
}

bool is_due(const Request& request, const v1::Stamp& now) {
  return request.stamp.cycle == 0 || request.stamp.epoch < now.epoch ||
         (request.stamp.epoch == now.epoch && request.stamp.cycle + 2 <= now.cycle);
}

}  // namespace saphira
