#include "machines.hpp"

#include <arpa/inet.h>

#include <sstream>

namespace saphira::bus::internal {

namespace {

/// True for the unicast address of one other machine, in its usual notation.
bool is_machine(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) != 1)
    return false;
  const auto first = ntohl(address.s_addr) >> 24U;
  return first != 0 && first != 127 && first < 224;
}

}  // namespace

void Machines::be(Addresses own) {
  const std::scoped_lock lock(mutex_);
  own_ = std::move(own);
}

void Machines::name(const std::string& peer, const std::string& address) {
  const std::scoped_lock lock(mutex_);
  named_[peer] = address;
}

void Machines::hear(const std::string& address, Time now) {
  const std::scoped_lock lock(mutex_);
  if (own_.contains(address) || !is_machine(address))
    return;
  std::erase_if(heard_, [&](const auto& item) { return now - item.second > kGone; });
  if (heard_.size() < kMost || heard_.contains(address))
    heard_[address] = now;
}

void Machines::tell(const std::string& program, const std::string& addresses) {
  Addresses all;
  std::istringstream text(addresses);
  for (std::string address; all.size() < kMost && std::getline(text, address, ',');)
    if (is_machine(address))
      all.insert(address);
  const std::scoped_lock lock(mutex_);
  if (all.empty())
    told_.erase(program);
  else
    told_[program] = std::move(all);
}

void Machines::forget(const std::string& program) {
  const std::scoped_lock lock(mutex_);
  told_.erase(program);
}

void Machines::forget_told() {
  const std::scoped_lock lock(mutex_);
  told_.clear();
}

std::string Machines::heard(Time now) const {
  const std::scoped_lock lock(mutex_);
  std::string text;
  for (const auto& [address, last] : heard_)
    if (now - last <= kGone)
      text += (text.empty() ? "" : ",") + address;
  return text;
}

Machines::Addresses Machines::others(Time now) const {
  const std::scoped_lock lock(mutex_);
  Addresses all;
  for (const auto& [address, last] : heard_)
    if (now - last <= kGone && !own_.contains(address))
      all.insert(address);
  for (const auto& [program, addresses] : told_)
    for (const auto& address : addresses)
      if (all.size() < kMost && !own_.contains(address))
        all.insert(address);
  for (const auto& [peer, address] : named_)
    if (!address.empty() && !own_.contains(address))
      all.insert(address);
  return all;
}

std::vector<std::string> Machines::silent(Time now) const {
  const std::scoped_lock lock(mutex_);
  std::vector<std::string> all;
  for (const auto& [peer, address] : named_)
    if (!address.empty() && !own_.contains(address) && !is_heard(address, now))
      all.push_back(peer);
  return all;
}

std::vector<std::string> Machines::unknown() const {
  const std::scoped_lock lock(mutex_);
  std::vector<std::string> all;
  for (const auto& [peer, address] : named_)
    if (address.empty())
      all.push_back(peer);
  return all;
}

bool Machines::is_heard(const std::string& address, Time now) const {
  const auto found = heard_.find(address);
  return found != heard_.end() && now - found->second <= kGone;
}

}  // namespace saphira::bus::internal
