#include "peers.hpp"

#include <algorithm>
#include <utility>

namespace saphira::bus::internal {

Peers::Program Peers::program_of(const WriterId& endpoint) {
  Program program{};
  std::copy_n(endpoint.begin(), program.size(), program.begin());
  return program;
}

void Peers::add(Ends& ends) {
  const std::scoped_lock lock(mutex_);
  ends_.insert(&ends);
}

void Peers::remove(Ends& ends) {
  const std::scoped_lock lock(mutex_);
  ends_.erase(&ends);
}

void Peers::match(Ends& ends, const WriterId& other) {
  const std::scoped_lock lock(mutex_);
  ends.matched_.insert(other);
  ends.before_.erase(other);
  if (const Program program = program_of(other); joined_.contains(program))
    programs_.try_emplace(program);
  if (!is_absent(program_of(other)))
    std::erase(ends.lost_, other);
  count(ends);
  wake_->signal();
}

void Peers::unmatch(Ends& ends, const WriterId& other) {
  const std::scoped_lock lock(mutex_);
  if (ends.matched_.erase(other) == 0)
    return;
  const auto program = programs_.find(program_of(other));
  if (program == programs_.end() || !program->second.absent)
    ends.lose(other);
  if (program != programs_.end() && !program->second.matched && !has_matches(program->first))
    programs_.erase(program);
  count(ends);
  wake_->signal();
}

void Peers::restart(Ends& ends) {
  const std::scoped_lock lock(mutex_);
  for (const WriterId& other : ends.matched_)
    if (!is_absent(program_of(other)))
      ends.before_.insert(other);
  ends.matched_.clear();
  ends.ticks_left_ = kRestart;
  std::erase_if(programs_, [&](const auto& program) {
    return !program.second.matched && !has_matches(program.first);
  });
  count(ends);
}

std::vector<WriterId> Peers::take_lost(Ends& ends) {
  const std::scoped_lock lock(mutex_);
  return std::exchange(ends.lost_, {});
}

std::vector<WriterId> Peers::take_returned(Ends& ends) {
  const std::scoped_lock lock(mutex_);
  return std::exchange(ends.returned_, {});
}

bool Peers::any_absent(const Ends& ends) const {
  const std::scoped_lock lock(mutex_);
  return ends.present_ < ends.matched_.size();
}

void Peers::join(const Program& program) {
  const std::scoped_lock lock(mutex_);
  joined_.insert(program);
  if (has_matches(program))
    programs_.try_emplace(program);
}

void Peers::leave(const Program& program) {
  const std::scoped_lock lock(mutex_);
  if (const auto found = joined_.find(program); found != joined_.end())
    joined_.erase(found);
}

void Peers::expect(const Program& program) {
  const std::scoped_lock lock(mutex_);
  programs_[program].matched = true;
}

void Peers::forget(const Program& program) {
  const std::scoped_lock lock(mutex_);
  const auto found = programs_.find(program);
  if (found == programs_.end())
    return;
  // The other matches of an absent program end soon as well, and were reported lost already.
  if (found->second.absent && has_matches(program))
    found->second.matched = false;
  else
    programs_.erase(found);
}

void Peers::tick(const std::set<Program>& heard) {
  const std::scoped_lock lock(mutex_);
  for (Ends* ends : ends_)
    if (!ends->before_.empty() && --ends->ticks_left_ <= 0)
      lose_old_matches(*ends);
  for (auto& [program, silence] : programs_) {
    if (heard.contains(program)) {
      silence.ticks = 0;
      silence.heard = true;
    } else if (!silence.absent) {
      ++silence.ticks;
    }
    const bool absent = silence.ticks >= (silence.heard ? kSilent : kSilentAtFirst);
    if (std::exchange(silence.absent, absent) != absent)
      change(program, absent);
  }
}

bool Peers::absent(const Program& program) const {
  const std::scoped_lock lock(mutex_);
  return is_absent(program);
}

bool Peers::is_absent(const Program& program) const {
  const auto found = programs_.find(program);
  return found != programs_.end() && found->second.absent;
}

void Peers::count(Ends& ends) const {
  ends.present_ = static_cast<std::size_t>(
      std::count_if(ends.matched_.begin(), ends.matched_.end(),
                    [&](const WriterId& other) { return !is_absent(program_of(other)); }));
}

void Peers::change(const Program& program, bool absent) {
  for (Ends* ends : ends_) {
    for (const WriterId& other : ends->matched_)
      if (program_of(other) == program)
        absent ? ends->lose(other) : ends->come_back(other);
    count(*ends);
  }
  wake_->signal();
}

void Peers::lose_old_matches(Ends& ends) {
  for (const WriterId& other : ends.before_)
    ends.lose(other);
  ends.before_.clear();
  wake_->signal();
}

bool Peers::has_matches(const Program& program) const {
  return std::any_of(ends_.begin(), ends_.end(), [&](const Ends* ends) {
    return std::any_of(ends->matched_.begin(), ends->matched_.end(),
                       [&](const WriterId& other) { return program_of(other) == program; });
  });
}

}  // namespace saphira::bus::internal
