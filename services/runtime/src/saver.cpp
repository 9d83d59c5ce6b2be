#include "saphira/runtime/saver.hpp"

#include <system_error>
#include <utility>

#include "saphira/base/durable.hpp"

namespace saphira::runtime {
namespace {

constexpr std::chrono::seconds kEvery{1};

}  // namespace

std::string Saver::offer(const std::function<std::string()>& text) {
  if (path_.empty() || Clock::now() - began_ < kEvery)
    return {};
  began_ = Clock::now();
  if (writing_.valid() &&
      writing_.wait_for(std::chrono::seconds::zero()) != std::future_status::ready)
    return {};
  bool good = !writing_.valid() || writing_.get();
  try {
    writing_ = std::async(std::launch::async, [file = path_, content = text()] {
      return replace_file(file, content, true);
    });
  } catch (const std::system_error&) {
    good = false;  // no thread was available
  }
  return std::exchange(works_, good) && !good ? path_ + " cannot be written" : "";
}

}  // namespace saphira::runtime
