#include "saphira/runtime/shell.hpp"

namespace saphira::runtime {
namespace {

/// Between two checks of files: in cycles, and without cycles in time.
constexpr std::uint64_t kFilePollPeriod = 10;
constexpr std::uint64_t kFilePollInLockstep = 100;  // there they are milliseconds
constexpr std::chrono::seconds kIdleFilePoll{1};

}  // namespace

Shell::Shell(bus::Node& node, const Make& make)
    : node_(node),
      cycle_(node),
      ports_(node, cycle_),
      service_(make(ports_)),
      processes_(node, service_->processes(),
                 [this](const std::string& name, ProcessAction action, std::uint32_t cycles) {
                   return service_->ask(name, action, cycles);
                 }) {}

bool Shell::step(const bus::Stop& stop) {
  const auto step = cycle_.next(stop, [this] { between(); });
  if (!step)
    return false;
  step_now(*step);
  return true;
}

bool Shell::advance() {
  const auto step = cycle_.poll();
  if (!step)
    return false;
  step_now(*step);
  return true;
}

void Shell::idle() {
  cycle_.idle([this] { between(); });
}

void Shell::step_now(const bus::Step& step) {
  stepped_ = Clock::now();
  processes_.step(cycle_.stamp());
  if (step.new_epoch)
    odom_.reset();
  const std::uint64_t odom = step.robot.odom;
  service_->step({cycle_.stamp(), step.robot, *step.description, step.new_epoch,
                  odom_.has_value() && *odom_ != odom});
  odom_ = odom;
  // After the robot has its command.
  if (++steps_ % (node_.options().lockstep ? kFilePollInLockstep : kFilePollPeriod) == 0)
    check_files();
  cycle_.done();
}

void Shell::between() {
  processes_.idle();
  service_->between(std::chrono::duration<double>(Clock::now() - stepped_).count());
  if (Clock::now() - checked_files_ >= kIdleFilePoll)
    check_files();
}

void Shell::check_files() {
  checked_files_ = Clock::now();
  service_->check_files();
}

}  // namespace saphira::runtime
