#include "saphira/watch/halt.hpp"

#include "saphira/bus/request_client.hpp"

namespace saphira::watch {

Halt::News Halt::update(bool confirmed, double now) {
  if (confirmed != confirmed_) {
    confirmed_ = confirmed;
    since_ = told_ = now;
  }
  if (confirmed_ && now > since_ + kMost)
    return News::given_up;
  if (now <= told_ + (confirmed_ && told_ == since_ ? kRest : kConfirm))
    return News::none;
  told_ = now;
  return confirmed_ ? News::not_at_rest : News::not_confirmed;
}

void Halt::end(v1::AnswerCode code) {
  well_ = well_ && bus::well(code);
}

}  // namespace saphira::watch
