#include "saphira/runtime/shell.hpp"

namespace saphira::runtime {
namespace {

/// Between two checks of files: in cycles, and without cycles in time.
constexpr std::uint64_t kFilePollPeriod = 10;
constexpr std::uint64_t kFilePollInLockstep = 100;  // there they are milliseconds
constexpr std::chrono::seconds kIdleFilePoll{1};

}  // namespace

Shell::Life::Life(bus::Node& node, const Make& make)
    : cycle(node),
      ports(node, cycle),
      service(make(ports)),
      processes(node, service->processes(),
                [this](const std::string& name, ProcessAction action, std::uint32_t cycles) {
                  return service->ask(name, action, cycles);
                }) {}

Shell::Shell(bus::Node& node, Make make) : node_(node), make_(std::move(make)) {
  begin();
}

void Shell::begin() {
  life_.reset();  // its endpoints are gone before the new ones are there
  life_ = std::make_unique<Life>(node_, make_);
  odom_.reset();
}

bool Shell::step(const bus::Stop& stop) {
  const auto step = life_->cycle.next(stop, [this] { between(); });
  if (step)
    step_now(*step);
  else if (!stop.requested())
    begin();
  return !stop.requested() || step;
}

bool Shell::advance() {
  if (life_->cycle.superseded())
    begin();
  const auto step = life_->cycle.poll();
  if (!step)
    return false;
  step_now(*step);
  return true;
}

void Shell::idle() {
  life_->cycle.idle([this] { between(); });
}

void Shell::step_now(const bus::Step& step) {
  stepped_ = Clock::now();
  life_->processes.step(life_->cycle.stamp());
  if (step.new_epoch)
    odom_.reset();
  const std::uint64_t odom = step.robot.odom;
  life_->service->step({life_->cycle.stamp(), step.robot, *step.description, step.new_epoch,
                        odom_.has_value() && *odom_ != odom});
  odom_ = odom;
  // After the robot has its command.
  if (++steps_ % (node_.options().lockstep ? kFilePollInLockstep : kFilePollPeriod) == 0)
    check_files();
  life_->cycle.done();
}

void Shell::between() {
  life_->processes.idle();
  life_->service->between(std::chrono::duration<double>(Clock::now() - stepped_).count());
  if (Clock::now() - checked_files_ >= kIdleFilePoll)
    check_files();
}

void Shell::check_files() {
  checked_files_ = Clock::now();
  life_->service->check_files();
}

}  // namespace saphira::runtime
