#include "saphira/cli/gathering.hpp"

#include <utility>

namespace saphira::cli {

bool Gathering::complete(std::size_t matched, double now) {
  if (std::exchange(matched_, matched) != matched)
    since_ = now;
  complete_ = complete_ || (matched > 0 && now - since_ >= kRest);
  return complete_ && matched > 0;
}

}  // namespace saphira::cli
