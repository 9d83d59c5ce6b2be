#include "saphira/bus/goal_client.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "saphira/base/format.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/idl/goal_words.hpp"

namespace saphira::bus {
namespace {

std::pair<std::uint64_t, std::uint64_t> key_of(const v1::GoalId& id) {
  return {id.writer, id.number};
}

constexpr std::chrono::milliseconds kToldAgain{10000};  // by a service that is started again

}  // namespace

GoalClient::GoalClient(Node& node, std::string requester, std::chrono::milliseconds keep)
    : node_(node),
      requester_(std::move(requester)),
      writer_(node.writer(topics::kGoals)),
      reader_(node.reader(topics::kGoalStatus)),
      keep_(keep) {}

v1::GoalId GoalClient::ask(v1::Goal goal) {
  v1::GoalId id{.writer = node_.instance(), .number = next_request_number()};
  own_[key_of(id)];  // before the writing, which may fail
  change(id, std::move(goal));
  return id;
}

void GoalClient::adopt(const v1::GoalId& id, v1::Goal goal) {
  own_[key_of(id)];
  change(id, std::move(goal));
}

void GoalClient::change(const v1::GoalId& id, v1::Goal goal) {
  goal.id = id;
  if (goal.requester.empty())
    goal.requester = requester_;
  if (!writer_.write(goal))
    throw std::runtime_error("the bus did not take goal " + describe(id));
  if (const auto own = own_.find(key_of(id)); own != own_.end())
    own->second.goal = std::move(goal);
}

void GoalClient::cancel(const v1::GoalId& id, const std::string& why, const v1::Person& by) {
  // A dispose carries only the key: a goal with a reason is disposed when it is forgotten.
  auto own = own_.find(key_of(id));
  if (own == own_.end() && !why.empty())
    own = own_.try_emplace(key_of(id)).first;
  v1::Goal goal = own == own_.end() ? v1::Goal() : own->second.goal;
  goal.id = id;
  goal.withdrawn = why;
  if (!by.name.empty())
    goal.person = by;
  if (why.empty() ? !writer_.dispose(goal) : !writer_.write(goal))
    throw std::runtime_error("the bus did not take the withdrawal of goal " + describe(id));
  if (own != own_.end() && !own->second.over)
    own->second.over = Clock::now();
}

void GoalClient::leave() {
  constexpr int kHeard = 500;  // [ms] a writer that ends repeats nothing
  bool withdraws = false;
  for (auto& [key, own] : own_)
    if (!own.over && own.goal.writer_lost == v1::WRITER_LOST_CANCEL && writer_.dispose(own.goal)) {
      own.over = Clock::now();
      withdraws = true;
    }
  if (withdraws)
    writer_.wait_acknowledged(kHeard);
}

void GoalClient::poll() {
  for (const auto& sample : reader_.take()) {
    const Key key = key_of(sample.data.id);
    const auto own = own_.find(key);
    if (!sample.info.disposed)
      known_[key] = sample.data;
    else if (own == own_.end())
      known_.erase(key);
    if (own == own_.end() || own->second.over)
      continue;
    if (sample.info.disposed)
      own->second.withdrawn = Clock::now();
    else
      own->second.withdrawn.reset();
    if (!sample.info.disposed && ended(sample.data.state))
      own->second.over = Clock::now();
  }
  forget();
  miss();
}

/// A goal whose status was withdrawn has ended, unless a service that was started again tells it.
void GoalClient::miss() {
  const auto now = Clock::now();
  for (auto& [key, own] : own_) {
    if (own.over || !own.withdrawn || now - *own.withdrawn < std::min(keep_, kToldAgain))
      continue;
    v1::GoalStatus& status = known_[key];
    status.id.writer = key.first;
    status.id.number = key.second;
    status.state = v1::GOAL_FAILED;
    status.code = v1::CODE_FORGOTTEN;
    status.reason =
        "it has ended, and this program has not heard how: it did not listen for more than a "
        "minute";
    own.over = now;
  }
}

/// Withdraws and forgets goals that ended long ago: over months there are many.
void GoalClient::forget() {
  const auto long_ago = Clock::now() - keep_;
  for (auto own = own_.begin(); own != own_.end();) {
    if (!own->second.over || *own->second.over > long_ago) {
      ++own;
      continue;
    }
    v1::Goal goal{.id = {own->first.first, own->first.second}};
    if (!writer_.dispose(goal))
      return;  // the bus is full: later
    known_.erase(own->first);
    own = own_.erase(own);
  }
}

bool GoalClient::knows(const v1::GoalId& id) const {
  return own_.contains(key_of(id)) || known_.contains(key_of(id));
}

std::optional<v1::GoalStatus> GoalClient::status(const v1::GoalId& id) const {
  const auto found = known_.find(key_of(id));
  if (found == known_.end())
    return std::nullopt;
  return found->second;
}

std::vector<v1::GoalStatus> GoalClient::statuses() const {
  std::vector<v1::GoalStatus> all;
  all.reserve(known_.size());
  for (const auto& [key, status] : known_)
    all.push_back(status);
  std::ranges::stable_sort(all, [](const v1::GoalStatus& a, const v1::GoalStatus& b) {
    return std::tuple(a.stamp.epoch, a.stamp.cycle, a.functor, a.id.number) <
           std::tuple(b.stamp.epoch, b.stamp.cycle, b.functor, b.id.number);
  });
  return all;
}

bool GoalClient::delivered(int timeout_ms) {
  const auto limit = Clock::now() + std::chrono::milliseconds(timeout_ms);
  const auto left = [&] {
    const auto rest = std::chrono::duration_cast<std::chrono::milliseconds>(limit - Clock::now());
    return std::max(rest, std::chrono::milliseconds(0));
  };
  while (writer_.matched() == 0) {
    if (left().count() == 0)
      return false;
    node_.wait(std::min(left(), std::chrono::milliseconds(50)));
  }
  return writer_.wait_acknowledged(static_cast<int>(left().count()));
}

std::string describe(v1::GoalState state) {
  return word_of(state);
}

std::optional<v1::GoalId> parse_goal_id(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos)
    return std::nullopt;
  const auto writer = number_in<std::uint64_t>(std::string_view(text).substr(0, colon), 16);
  const auto count = number_in<std::uint64_t>(std::string_view(text).substr(colon + 1));
  if (!writer || !count)
    return std::nullopt;
  return v1::GoalId{.writer = *writer, .number = *count};
}

std::string describe(const v1::GoalStatus& status) {
  std::string line = describe(status.state);
  if (!ended(status.state) && !status.step.empty())
    line += ": " + status.step;
  if (status.state == v1::GOAL_UNDERWAY) {
    line += format(" (%.0f %% done", 100.0 * status.progress);
    // The level of most activities is the part that is done.
    if (std::abs(status.level - status.progress) >= 0.01)
      line += format(", level %.2f", status.level);
    line += ")";
  }
  if (!status.reason.empty())
    line += (ended(status.state) ? ": " : " [") + status.reason + (ended(status.state) ? "" : "]");
  if (!status.note.empty())
    line += "; it " + status.note;
  return line;
}

}  // namespace saphira::bus
