#include "saphira/runtime/saver.hpp"

#include <system_error>
#include <utility>

#include "saphira/base/durable.hpp"
#include "saphira/base/text.hpp"

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
  std::string trouble = writing_.valid() ? writing_.get() : "";
  try {
    writing_ = std::async(std::launch::async, [file = path_, content = text()] {
      return replace_file(file, content, true) ? std::string() : cannot_be(file, "written");
    });
  } catch (const std::system_error& error) {  // no thread was available
    trouble = path_ + ": cannot be written: " + error.what();
  }
  const bool worked = std::exchange(trouble_, trouble).empty();
  return worked ? trouble_ : "";
}

}  // namespace saphira::runtime
