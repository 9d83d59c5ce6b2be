#include "saphira/intentions/requester.hpp"

#include "saphira/base/numbers.hpp"

namespace saphira::intentions {

void Requester::cut_off(Ticks now) {
  if (state_ != State::kHeard)
    return;
  state_ = State::kCutOff;
  since_ = now;
}

void Requester::recall(Ticks now) {
  state_ = State::kRecalled;
  since_ = now;
}

void Requester::meet_bridge() {
  if (state_ == State::kRecalled)
    state_ = State::kSwitchedOn;
}

/// The longest wait; 0: none.
Ticks Requester::patience(v1::WriterLost policy) const {
  const bool kept = policy == v1::WRITER_LOST_KEEP;
  switch (state_) {
    case State::kCutOff:
      return kept ? 0 : kCutOff;
    case State::kRecalled:
    case State::kSwitchedOn:
      return kept ? kMeeting : kRecalled;
    case State::kHeard:
    case State::kLeft:
      break;
  }
  return 0;
}

bool Requester::is_meeting(Ticks now) const {
  return (state_ == State::kRecalled || state_ == State::kSwitchedOn) && now - since_ < kMeeting;
}

std::string Requester::why_to_wait(v1::WriterLost policy) const {
  const Ticks wait = patience(policy);
  return wait == 0 ? ""
                   : "the program that asked for it is not heard: it goes on when that is, and "
                     "ends after " +
                         plain(in_seconds(wait)) + " s";
}

Requester::Turn Requester::pass(v1::WriterLost policy, Ticks now) {
  const Ticks wait = patience(policy);
  if (wait == 0 || now - since_ < wait)
    return Turn::kNone;
  if (state_ != State::kRecalled || policy != v1::WRITER_LOST_KEEP)
    return Turn::kEnds;
  state_ = State::kLeft;
  return Turn::kKept;
}

std::string Requester::why_ended(v1::WriterLost policy) const {
  if (state_ == State::kCutOff)
    return "the program that asked for it is gone, or was cut off for " +
           plain(in_seconds(kCutOff)) + " s";
  return std::string(
             "intentions was restarted, and the program that asked for it has not been heard "
             "since") +
         (policy == v1::WRITER_LOST_KEEP
              ? "; it was to be kept, and the bridge was restarted as well: ask again"
              : "");
}

}  // namespace saphira::intentions
