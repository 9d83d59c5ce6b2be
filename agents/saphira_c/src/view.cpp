#include "view.hpp"

#include <memory>
#include <mutex>

namespace saphira::c {
namespace {

std::mutex mutex;
View newest;  // under the mutex
std::uint64_t newest_number = 0;

struct Mine {
  View view;
  std::uint64_t number = 0;
  bool owned = false;
};
Mine& mine() {
  thread_local const std::unique_ptr<Mine> of_thread = std::make_unique<Mine>();
  return *of_thread;
}

/// Takes the next view. A sonar reading counts as new for each thread once.
void take(Mine& of_thread, const View& next) {
  const View before = of_thread.view;
  of_thread.view = next;
  for (std::size_t i = 0; i < next.sonars.size(); ++i) {
    const bool same = next.read[i] == before.read[i];
    of_thread.view.sonars[i].snew = same ? before.sonars[i].snew : 0xFFFF;
  }
}

}  // namespace

View& view() {
  Mine& of_thread = mine();
  if (of_thread.owned)
    return of_thread.view;
  const std::lock_guard lock(mutex);
  if (of_thread.number != newest_number) {
    take(of_thread, newest);
    of_thread.number = newest_number;
  }
  return of_thread.view;
}

void own_view() {
  mine().owned = true;
}

void publish(const View& next) {
  take(mine(), next);
  const std::lock_guard lock(mutex);
  newest = next;
  ++newest_number;
}

}  // namespace saphira::c
