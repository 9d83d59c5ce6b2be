// Messages of browsers to the console, one per line, from three of them in turn. Each is parsed or
// gives an error in words; an active command comes from a recent sample of the operator who holds
// control; commands are finite numbers; the state that the pages get is JSON.

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "fuzz.hpp"
#include "saphira/console/access.hpp"
#include "saphira/console/message.hpp"
#include "saphira/teleop/control.hpp"

using namespace saphira::console;

namespace {

using saphira::teleop::Control;
using saphira::teleop::Order;

constexpr Control::OperatorId kPeople = 3;

/// True where its sample counts.
bool apply(Control& control, Control::OperatorId who, const Message& message, double now) {
  if (const auto* const wrong = std::get_if<Wrong>(&message))
    saphira::fuzz::require(!wrong->why.empty());
  if (const auto* const hello = std::get_if<Hello>(&message))
    control.join(who, hello->name);
  else if (const auto* const take = std::get_if<TakeControl>(&message))
    control.take(who, take->force, now);
  else if (std::get_if<AskForControl>(&message) != nullptr)
    control.ask(who);
  else if (std::get_if<ReleaseControl>(&message) != nullptr)
    control.release(who);
  else if (std::get_if<HandBack>(&message) != nullptr)
    control.leave(who);
  else if (const auto* const sample = std::get_if<Control::Sample>(&message))
    return control.drive(who, *sample, now).empty();
  return false;
}

}  // namespace

void saphira::fuzz::run(std::string_view rest) {
  AccessSettings access{"right", {"robot.example"}};
  Caller caller{std::string(rest.substr(0, 40)), std::string(rest.substr(0, rest.size() / 2)),
                false};
  static_cast<void>(refusal(access, caller));
  require(!(may_watch(access, caller) ||
            visitor_of(access, {}, rest, 0).may(saphira::security::DoorRight::watch)));

  const Control::Settings settings;
  Control control(settings);
  for (Control::OperatorId who = 1; who <= kPeople; ++who)
    control.join(who, "person");
  double now = 100.0;
  std::array<double, kPeople + 1> newest{};
  for (Control::OperatorId who = 1; !rest.empty(); who = who % kPeople + 1) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    now += 0.01 * static_cast<double>(line.size() % 16);
    if (apply(control, who, parse_message(line), now))
      newest[who] = now;
    const Order order = control.order(now);
    require(!(order.active &&
              (control.holder() == 0 || now - newest[control.holder()] > settings.hold + 1e-9)));
    require(std::isfinite(order.velocity) && std::isfinite(order.rotation));
    if (!nlohmann::json::accept(to_json(control.state())))
      std::abort();
  }
}
