#include "direct.hpp"
#include "saphira/base/identity.hpp"

namespace saphira::cli {

namespace {

using std::chrono::milliseconds;

constexpr int kReleases = 4;         ///< repetitions of a release: the topic is best effort
constexpr double kUnanswered = 1.0;  ///< [s]

}  // namespace

DirectDriver::DirectDriver(bus::Node& node, const bus::Topic<v1::MotorCommand>& topic,
                           const std::string& program)
    : node_(node), processes_(node), commands_(node.writer(topic)), source_(person(program)) {}

void DirectDriver::drive(v1::MotorCommand command) {
  // The stamp names the robot state that the command answers: an old one is refused.
  if (command.stamp.cycle == 0 && robot_)
    command.stamp = robot_->stamp;
  if (command.source.empty())
    command.source = source_;
  source_ = command.source;
  if (number_ == 0)
    drove_ = Clock::now();
  command.number = ++number_;
  // Unique over restarts too, or the bridge would take the first for an old one.
  command.move = node_.instance() + command.move;
  commands_.write(command);
}

void DirectDriver::release() {
  for (int i = 0; i < kReleases; ++i) {
    v1::MotorCommand command{.source = source_};
    drive(command);
    node_.wait(milliseconds(20));
  }
}

void DirectDriver::poll() {
  processes_.poll();
  robot_.poll();
  for (const auto& sample : grants_.take()) {
    grant_ = sample.data;
    if (std::string who = stops_.hear(*grant_); !who.empty())
      stopped_by_ = std::move(who);
    for (const v1::Refusal& refusal : grant_->refused)
      if (is_named(refusal.source, source_))
        refusal_ = refusal.reason;
  }
  if (drives()) {
    refusal_.clear();
    drove_ = Clock::now();
  }
}

bool DirectDriver::drives() const {
  return grant_ && grant_->role != v1::ROLE_NONE && is_named(grant_->source, source_);
}

std::string DirectDriver::trouble() const {
  if (!grant_)
    return seconds_since(began_) < kUnanswered ? ""
                                               : "no bridge is heard; " + who_is_there(processes_);
  if (!refusal_.empty())
    return "refused: " + refusal_;
  if (!drives())
    return seconds_since(drove_) < kUnanswered ? "" : describe(*grant_);
  if (grant_->guard != v1::GUARD_NONE)
    return "the guard beside the robot " + std::string(name_of(grant_->guard)) +
           " it: " + grant_->guard_reason;
  return {};
}

std::optional<std::string> DirectDriver::news() {
  std::string now = trouble();
  // Distances in a reason change all the time: only a new kind of trouble is news.
  const std::string kind = now.substr(0, now.find_first_of("0123456789"));
  if (kind == told_)
    return std::nullopt;
  told_ = kind;
  return now.empty() ? std::nullopt : std::optional(now);
}

}  // namespace saphira::cli
