#include "entrance.hpp"

#include <string_view>
#include <utility>

#include "saphira/base/fnv1a.hpp"

namespace saphira::bus::internal {

Entrance::Fate Entrance::announced(const Prefix& prefix, const std::string& address, Time now,
                                   std::optional<Sealed> sealed) {
  const std::scoped_lock lock(mutex_);
  if (const auto known = known_.find(prefix); known != known_.end()) {
    std::optional<std::chrono::seconds>& newest = known->second.sealed;
    if (newest && sealed && sealed->time < *newest - kSwapped)
      return dropped(address, now, "they repeat announcements of members");
    // A sealed participant goes on to seal.
    const Fate found = newest && !sealed ? Fate::drops : fate(known->second, now);
    if (newest && sealed)
      newest = std::max(*newest, sealed->time);
    return found == Fate::drops ? dropped(address, now) : found;
  }
  if (const auto refused = refused_.find(prefix); refused != refused_.end()) {
    if (now - refused->second < kRefusal)
      return dropped(address, now);
    refused_.erase(refused);
  }
  if (!has_place(prefix, now, sealed))
    return dropped(address, now);
  Known& known = known_[prefix] = {.since = now, .address = address};
  ++waiting_;
  if (sealed) {
    known.sealed = sealed->time;
    ++sealed_waiting_;
  }
  return Fate::waits;
}

bool Entrance::has_place(const Prefix& prefix, Time now, const std::optional<Sealed>& sealed) {
  if (!sealed && seal_ == Seal::required)
    return false;
  if (sealed && sealed_waiting_ >= kRepeated && (sealed->age > kFresh || sealed->age < -kFresh))
    return false;
  if (!sealed && waiting_ >= kCrowd && !heard_twice(prefix, now))
    return false;
  const auto is_full = [&] {
    return waiting_ >= kMost ||
           (!sealed && seal_ != Seal::unknown && waiting_ - sealed_waiting_ >= kMostUnsealed);
  };
  // Fast DDS did not take these, and will not tell their end.
  if (is_full())
    std::erase_if(known_, [&](const auto& one) {
      const bool ends =
          one.second.found == 0 && !one.second.in && now - one.second.since > kPatience;
      if (ends)
        leave(one.second);
      return ends;
    });
  return !is_full();
}

void Entrance::leave(const Known& known) {
  --waiting_;
  if (known.sealed)
    --sealed_waiting_;
}

Entrance::Fate Entrance::shakes_hands(const Prefix& prefix, Time now) {
  const std::scoped_lock lock(mutex_);
  const auto known = known_.find(prefix);
  return known == known_.end() ? Fate::drops : fate(known->second, now);
}

Entrance::Fate Entrance::sends(const Prefix& prefix, Time now) {
  const std::scoped_lock lock(mutex_);
  const auto known = known_.find(prefix);
  if (known == known_.end())
    return seal_ == Seal::required ? Fate::drops : Fate::passes;
  return fate(known->second, now);
}

void Entrance::found(const Prefix& prefix) {
  const std::scoped_lock lock(mutex_);
  if (const auto known = known_.find(prefix); known != known_.end())
    ++known->second.found;
}

void Entrance::let_in(const Prefix& prefix) {
  const std::scoped_lock lock(mutex_);
  const auto [known, is_new] = known_.try_emplace(prefix);
  if (!std::exchange(known->second.in, true) && !is_new)
    leave(known->second);
}

void Entrance::refuse(const Prefix& prefix) {
  const std::scoped_lock lock(mutex_);
  if (const auto known = known_.find(prefix); known != known_.end())
    known->second.refused = true;
}

void Entrance::forget(const Prefix& prefix, Time now) {
  const std::scoped_lock lock(mutex_);
  const auto known = known_.find(prefix);
  if (known == known_.end() || --known->second.found > 0)
    return;
  if (known->second.refused) {
    if (refused_.size() >= kMostRefused)
      refused_.clear();
    refused_[prefix] = now;
  }
  if (!known->second.in)
    leave(known->second);
  known_.erase(known);
}

bool Entrance::is_in(const Prefix& prefix) const {
  const std::scoped_lock lock(mutex_);
  const auto known = known_.find(prefix);
  return known != known_.end() && known->second.in;
}

bool Entrance::is_refused(const Prefix& prefix) const {
  const std::scoped_lock lock(mutex_);
  const auto known = known_.find(prefix);
  return known != known_.end() && known->second.refused;
}

void Entrance::limit(const Prefix& prefix, const std::string& robot) {
  const std::scoped_lock lock(mutex_);
  if (const auto known = known_.find(prefix); known != known_.end() && !robot.empty())
    known->second.robot = robot;
}

std::string Entrance::robot_of(const Prefix& prefix) const {
  const std::scoped_lock lock(mutex_);
  const auto known = known_.find(prefix);
  return known == known_.end() ? std::string() : known->second.robot;
}

std::string Entrance::address_of(const Prefix& prefix) const {
  const std::scoped_lock lock(mutex_);
  const auto known = known_.find(prefix);
  return known == known_.end() ? std::string() : known->second.address;
}

Entrance::Fate Entrance::drop(const std::string& address, Time now, const std::string& proof) {
  const std::scoped_lock lock(mutex_);
  return dropped(address, now, proof);
}

std::string Entrance::strangers(Time now) const {
  const auto seconds = [](Time::duration time) {
    return std::to_string(std::chrono::duration_cast<std::chrono::seconds>(time).count()) + " s";
  };
  const std::scoped_lock lock(mutex_);
  std::string text;
  for (const auto& [address, stranger] : strangers_)
    if (!stranger.proofs.empty() && now - stranger.last < kSilence)
      text += (text.empty() ? "strangers are kept out: " : ", ") +
              (address.empty() ? "other addresses" : address) + " (" +
              std::to_string(stranger.packets) + " packets in " +
              seconds(stranger.last - stranger.first) + ", the last " +
              seconds(now - stranger.last) + " ago)";
  return text;
}

std::vector<std::string> Entrance::take_new_strangers() {
  const std::scoped_lock lock(mutex_);
  std::vector<std::string> texts;
  for (auto& [address, stranger] : strangers_)
    for (auto& [proof, named] : stranger.proofs)
      if (!std::exchange(named, true))
        texts.push_back("strangers at " + (address.empty() ? "other addresses" : address) +
                        " are kept out: " + (proof.empty() ? "what they send is dropped" : proof) +
                        "; the status counts their packets");
  return texts;
}

Entrance::Fate Entrance::dropped(const std::string& address, Time now, const std::string& proof) {
  auto found = strangers_.find(address);
  if (found == strangers_.end()) {
    std::erase_if(strangers_, [&](const auto& one) { return now - one.second.last >= kSilence; });
    found = strangers_.try_emplace(strangers_.size() < kMostAddresses ? address : "").first;
  }
  Stranger& stranger = found->second;
  if (now - stranger.last >= kSilence)
    stranger = {};
  if (stranger.packets++ == 0)
    stranger.first = now;
  stranger.last = now;
  if ((!proof.empty() || stranger.packets >= kStranger) && stranger.proofs.size() < kMostProofs)
    stranger.proofs.try_emplace(proof);
  return Fate::drops;
}

Entrance::Fate Entrance::fate(const Known& known, Time now) const {
  if (known.in)
    return Fate::passes;
  return known.refused || now - known.since > patience(known) ? Fate::drops : Fate::waits;
}

bool Entrance::heard_twice(const Prefix& prefix, Time now) {
  Fnv1a hash;
  hash.add(std::to_string(seed_));
  hash.add(std::string_view(reinterpret_cast<const char*>(prefix.data()), prefix.size()));
  Heard& heard = heard_[hash.value() % heard_.size()];
  const auto ago = now - heard.when;
  if (heard.prefix == prefix && ago <= kTwiceAtMost)
    return ago >= kTwice;
  heard = {prefix, now};
  return false;
}

}  // namespace saphira::bus::internal
