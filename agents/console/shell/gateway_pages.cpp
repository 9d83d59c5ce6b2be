// The pages' side: their messages, and the replies.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "gateway.hpp"
#include "key.hpp"
#include "maps/shell/convert.hpp"
#include "requests/shell/convert.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/format.hpp"
#include "saphira/cli/goal_words.hpp"
#include "saphira/cli/map_words.hpp"
#include "saphira/situation/words.hpp"

namespace saphira::console {

namespace {

using security::DoorRight;

constexpr std::size_t kMostQueued = 64;  // texts for a page that does not read
constexpr double kCanceled = 2.0;        // [s] for the end of a goal

/// For the bus: whom the page's key names.
v1::Person person_of(const Visitor& visitor) {
  return visitor.person ? v1::Person{visitor.person->name, security::role_of(visitor.right)}
                        : v1::Person{};
}

std::optional<v1::GoalId> goal_id(const std::string& text) {
  unsigned long long writer = 0;
  unsigned long long number = 0;
  int used = 0;
  if (std::sscanf(text.c_str(), "%llx:%llx%n", &writer, &number, &used) != 2 ||
      static_cast<std::size_t>(used) != text.size())
    return std::nullopt;
  return v1::GoalId{.writer = writer, .number = number};
}

}  // namespace

void Gateway::opened(Connection connection, Channel channel, const Caller& caller) {
  Page& page = pages_[connection];
  page.channel = channel;
  page.caller = caller;
  page.opened = now();
}

void Gateway::closed(Connection connection) {
  const auto found = pages_.find(connection);
  if (found == pages_.end())
    return;
  control_.leave(connection);
  if (found->second.flow)
    found->second.flow->close(connection);
  if (found->second.greeted && found->second.channel == Channel::telemetry)
    --viewers_;
  pages_.erase(found);
  show_control();
}

std::optional<std::string> Gateway::next(Connection connection) {
  const auto found = pages_.find(connection);
  if (found == pages_.end())
    return std::nullopt;
  Page& page = found->second;
  if (!page.queue.empty()) {
    std::string text = std::move(page.queue.front());
    page.queue.pop_front();
    return text;
  }
  if (!page.greeted)
    return std::nullopt;
  if (page.channel == Channel::simulator && simulator_) {
    if (page.world != simulator_->world().number) {
      page.world = simulator_->world().number;
      server_.want(connection);
      return simulator_->world().line;
    }
    if (page.scene != simulator_->scene().number) {
      page.scene = simulator_->scene().number;
      return simulator_->scene().line;
    }
  }
  if (page.channel == Channel::pictures)
    return cameras_.next(*page.flow, connection, now());
  if (page.channel != Channel::telemetry)
    return std::nullopt;
  return board_.frame(page.viewer, now());
}

void Gateway::say(Connection connection, std::string text) {
  const auto found = pages_.find(connection);
  if (found == pages_.end())
    return;
  if (found->second.queue.size() >= kMostQueued) {
    server_.close(connection);
    return;
  }
  found->second.queue.push_back(std::move(text));
  server_.want(connection);
}

void Gateway::answer(Connection connection, std::uint64_t reference, bool well,
                     const std::string& text, const std::string& id) {
  say(connection, "{\"type\":\"answer\",\"reference\":" + std::to_string(reference) +
                      ",\"well\":" + (well ? "true" : "false") + ",\"text\":" + quoted(text) +
                      ",\"id\":" + quoted(id) + "}");
}

bool Gateway::came(Connection connection, const std::string& text) {
  const auto found = pages_.find(connection);
  if (found == pages_.end())
    return false;
  Page& page = found->second;
  if (page.channel == Channel::simulator && page.greeted) {
    ask_simulator(connection, page, text);
    return true;
  }
  const Message message = parse_message(text);
  if (const auto* wrong = std::get_if<Wrong>(&message)) {
    say(connection, "{\"type\":\"wrong\",\"why\":" + quoted(wrong->why) + "}");
    return true;
  }
  if (const auto* hello = std::get_if<Hello>(&message))
    return greet(connection, page, *hello);
  if (!page.greeted)
    return false;
  if (const auto* ack = std::get_if<Ack>(&message)) {
    if (page.channel != Channel::pictures) {
      Board::seen(page.viewer, ack->frame, now());
      server_.want(connection);
      return true;
    }
    page.flow->acknowledged(connection, ack->frame, now());
    for (const auto& [each, other] : pages_)
      if (other.flow == page.flow)
        server_.want(each);
  } else if (page.channel == Channel::commands) {
    obey(connection, page, message);
  }
  return true;
}

void Gateway::ask_simulator(Connection connection, const Page& page, std::string text) {
  const auto refuse = [&](const char* why) {
    say(connection, "{\"type\":\"trouble\",\"text\":" + quoted(why) + "}");
  };
  if (!page.visitor.may(DoorRight::operate))
    return refuse(
        "with this key, or without one, you may watch: open the address that saphira has printed");
  std::ranges::replace(text, '\n', ' ');  // one line for each wish
  if (!simulator_ || !simulator_->say(text))
    refuse("the simulator is not there");
}

bool Gateway::greet(Connection connection, Page& page, const Hello& hello) {
  if (page.greeted)
    return true;
  page.visitor = visitor_of(access_, keys_.keys(), hello.key, unix_seconds());
  page.greeted = page.visitor.may(DoorRight::watch) || may_watch(access_, page.caller);
  page.name = name_of(page.visitor, hello.name);
  if (!hello.key.empty() && !page.visitor.may(DoorRight::watch))
    audit_.wrong_key("the console", now(), keys_.keys().ended(hello.key, unix_seconds()));
  if (page.greeted && page.channel == Channel::telemetry)
    ++viewers_;
  if (page.visitor.may(DoorRight::drive) && page.channel == Channel::commands)
    admit(connection, page, hello);
  if (page.greeted && page.channel == Channel::pictures)
    share_pictures(connection, page, hello.ticket);
  if (page.greeted && (page.channel == Channel::telemetry || page.channel == Channel::pictures))
    return true;
  // A page without the key gets this message, and is closed without the key in time.
  say(connection,
      std::string("{\"type\":\"hello\",\"id\":") + std::to_string(connection) +
          ",\"may_watch\":" + (page.greeted ? "true" : "false") +
          ",\"may_drive\":" + (page.visitor.may(DoorRight::drive) ? "true" : "false") +
          ",\"may_operate\":" + (page.visitor.may(DoorRight::operate) ? "true" : "false") +
          ",\"ticket\":" + quoted(page.ticket) + "}");
  return true;
}

void Gateway::name(Connection connection, Page& page, const std::string& name) {
  page.name = name;
  control_.join(connection, name.empty() ? "somebody" : name);
}

/// With the page's other connections for pictures.
void Gateway::share_pictures(Connection connection, Page& page, const std::string& ticket) {
  for (const auto& [other, known] : pages_)
    if (known.flow && known.ticket == ticket && !ticket.empty())
      page.flow = known.flow;
  if (!page.flow)
    page.flow = std::make_shared<PictureFlow>();
  page.ticket = ticket;
  page.flow->open(connection);
}

/// An operator, or a further connection of one.
void Gateway::admit(Connection connection, Page& page, const Hello& hello) {
  if (hello.ticket.empty()) {
    page.ticket = new_key();
    page.operator_id = connection;
    name(connection, page, page.name);
    if (page.visitor.person)
      audit_.write({.act = v1::AUDIT_LET_IN,
                    .who = page.name + " at the console",
                    .text = std::string("to ") + security::name_of(page.visitor.right)});
    return;
  }
  for (const auto& [other, known] : pages_)
    if (known.ticket == hello.ticket)
      page.operator_id = other;
}

/// A page whose key was revoked, or holds no longer, is closed.
void Gateway::look_at_keys() {
  if (const std::string trouble = keys_.reload(unix_seconds()); !trouble.empty())
    node_.error(trouble);
  for (const auto& [connection, page] : pages_)
    if (page.visitor.person && !keys_.keys().holds(*page.visitor.person, unix_seconds()))
      server_.close(connection);
}

void Gateway::obey(Connection connection, Page& page, const Message& message) {
  // A person who watches from this machine has no key.
  const DoorRight wanted = right_for(message);
  if (wanted > DoorRight::watch && !page.visitor.may(wanted)) {
    say(connection, page.visitor.person
                        ? "{\"type\":\"note\",\"text\":\"Your key is to " +
                              std::string(security::name_of(page.visitor.right)) +
                              "; this needs one to " + security::name_of(wanted) +
                              " (saphira keys).\"}"
                        : "{\"type\":\"note\",\"text\":\"Without the key you may watch, and stop "
                          "the robot. Open "
                          "the address with the key that saphira console prints.\"}");
    return;
  }
  if (const auto* ping = std::get_if<Ping>(&message)) {
    return say(connection, format("{\"type\":\"pong\",\"at\":%.3f,\"cycle\":%llu}", ping->at,
                                  static_cast<unsigned long long>(stamp_.cycle)));
  }
  if (std::holds_alternative<EmergencyStop>(message)) {
    pilot_.press(operator_of(page.name));
    press_estop();
    return;
  }
  if (const auto* stop = std::get_if<StopRobot>(&message))
    return send(stops_, bus::request("stop", {bus::text("by", operator_of(page.name))}), connection,
                page, stop->reference);
  if (const auto* show = std::get_if<ShowRobots>(&message)) {
    page.robots = show->shown;
    return;
  }
  if (const auto* stop = std::get_if<StopRobots>(&message))
    return stop_robots(connection, page, *stop);
  const auto note = [&](const std::string& why) {
    if (!why.empty())
      say(connection, "{\"type\":\"note\",\"text\":" + quoted(why) + "}");
  };
  if (const auto* sample = std::get_if<teleop::Control::Sample>(&message))
    take_sample(connection, page, *sample);
  else if (const auto* rename = std::get_if<Rename>(&message))
    name(connection, page, name_of(page.visitor, rename->name));
  else if (const auto* take = std::get_if<TakeControl>(&message))
    note(control_.take(connection, take->force, now()));
  else if (std::holds_alternative<AskForControl>(message))
    note(control_.ask(connection));
  else if (const auto* give = std::get_if<GiveControl>(&message))
    note(control_.give(connection, give->to, now()));
  else if (std::holds_alternative<ReleaseControl>(message))
    control_.release(connection);
  else if (std::holds_alternative<HandBack>(message))
    hand_back(connection);
  else if (std::holds_alternative<ResetEmergencyStop>(message))
    send(resets_, bus::request("reset"), connection, page, 0);
  else if (const auto* goal = std::get_if<AskGoal>(&message))
    ask_goal(connection, page, *goal);
  else if (const auto* cancel = std::get_if<CancelGoal>(&message))
    cancel_goal(connection, page, *cancel);
  else if (const auto* words = std::get_if<Say>(&message))
    hear(page, *words);
  else if (const auto* process = std::get_if<AskProcess>(&message))
    send(processes_,
         bus::request(process->functor, {bus::text("process", process->process)}, process->service),
         connection, page, process->reference);
  else if (const auto* change = std::get_if<ChangeMap>(&message))
    change_map(connection, page, *change);
  else if (const auto* save = std::get_if<SaveMap>(&message))
    save_map(connection, *save);
  else if (const auto* piece = std::get_if<LoadMap>(&message))
    load_map(connection, page, *piece);
  else if (const auto* out = std::get_if<PointOut>(&message)) {
    pointed_out_.write({.stamp = stamp_,
                        .source = operator_of(page.name),
                        .functor = "pointed_out",
                        .arguments = {bus::point("position", out->x, out->y, 0.0,
                                                 out->in_map ? v1::FRAME_MAP : v1::FRAME_ODOM)}});
  }
  show_control();
}

void Gateway::stop_robots(Connection connection, const Page& page, const StopRobots& stop) {
  const StopOrder order = stop_order(robots_seen(), stop.robot, page.visitor.right);
  for (const std::string& name : order.robots) {
    if (name != node_.options().robot)
      robots_.stop(name, order.latched, operator_of(page.name));
    else if (order.latched)
      pilot_.press(operator_of(page.name));
    else
      send(stops_, bus::request("stop", {bus::text("by", operator_of(page.name))}), connection,
           page, 0);
  }
  press_estop();
  robots_.poll(now());
  answer(connection, stop.reference, order.well, order.text);
}

void Gateway::take_sample(Connection connection, Page& page,
                          const teleop::Control::Sample& sample) {
  if (page.operator_id == control_.holder())
    detour_.shows(sample.cycle, stamp_.cycle, now());
  const std::string why = control_.drive(page.operator_id, sample, now());
  // Of several connections one is quicker: an overtaken sample is not reported.
  if (why == page.refused || why == teleop::Control::kRepeated)
    return;
  page.refused = why;
  say(connection, "{\"type\":\"drive\",\"refused\":" + quoted(why) + "}");
}

void Gateway::hand_back(Connection connection) {
  if (control_.holder() != 0 && control_.holder() != connection) {
    say(connection,
        "{\"type\":\"note\",\"text\":\"Somebody else has control: it is not yours to hand "
        "back.\"}");
    return;
  }
  control_.release(connection);
  pilot_.hand_back();
}

void Gateway::ask_goal(Connection connection, const Page& page, const AskGoal& ask) {
  try {
    v1::Goal goal = cli::parse_request(words_of(ask.words));
    goal.requester = page.visitor.person ? "the console" : operator_of(page.name);
    goal.person = person_of(page.visitor);
    const v1::GoalId id = goals_.ask(goal);
    answer(connection, ask.reference, true, cli::describe(goal), key_text({id.writer, id.number}));
  } catch (const std::exception& error) {  // the person's text, or a bus that does not take it
    answer(connection, ask.reference, false, error.what());
  }
}

/// The answer has the file as `file`.
void Gateway::save_map(Connection connection, const SaveMap& save) {
  if (!map_)
    return answer(connection, save.reference, false, "registration is not heard: there is no map");
  try {
    say(connection, "{\"type\":\"answer\",\"reference\":" + std::to_string(save.reference) +
                        ",\"well\":true,\"text\":\"\",\"id\":" + quoted(map_->source) +
                        ",\"file\":" + quoted(maps::to_text(maps::from_bus(*map_))) + "}");
  } catch (const std::invalid_argument& error) {  // no file could hold it
    answer(connection, save.reference, false, error.what());
  }
}

/// Registration reads the file, too: a bad one changes nothing.
void Gateway::load_map(Connection connection, Page& page, const LoadMap& piece) {
  try {
    const auto text = page.upload.take(piece);
    if (!text)
      return;
    maps::check_map(*text, piece.name);
    send(registration_,
         bus::request("load", {bus::text("text", *text), bus::text("name", piece.name)}),
         connection, page, piece.reference);
  } catch (const std::exception& error) {  // of the file, or a bus that does not take it
    answer(connection, piece.reference, false, error.what());
  }
}

/// Without the forms that read files of this machine.
void Gateway::change_map(Connection connection, const Page& page, const ChangeMap& change) {
  try {
    const std::vector<std::string> words = words_of(change.words);
    if (words.empty() || (words[0] != "put" && words[0] != "remove" && words[0] != "place"))
      throw std::invalid_argument("expected put, remove or place");
    send(registration_, to_bus(cli::parse_map_request(words, {})), connection, page,
         change.reference);
  } catch (const std::exception& error) {  // the person's text, or a bus that does not take it
    answer(connection, change.reference, false, error.what());
  }
}

void Gateway::cancel_goal(Connection connection, const Page& page, const CancelGoal& cancel) {
  const auto id = goal_id(cancel.id);
  if (!id) {
    answer(connection, cancel.reference, false, "expected the id of a goal");
    return;
  }
  if (!goals_.knows(*id)) {
    answer(connection, cancel.reference, false, "there is no goal " + cancel.id + " on the list");
    return;
  }
  goals_.cancel(*id, "by " + operator_of(page.name), person_of(page.visitor));
  canceling_.push_back({connection, cancel.reference, *id, now() + kCanceled});
}

/// Answers each page that asked to cancel a goal: it has ended, or it has not within the time.
/// The intentions service decides about the right to cancel.
void Gateway::tell_cancels() {
  std::erase_if(canceling_, [this](const Canceling& one) {
    const auto status = goals_.status(one.goal);
    const bool done = !status || bus::ended(status->state);
    if (!done && now() < one.until)
      return false;
    answer(one.connection, one.reference, done,
           done ? "withdrawn"
                : "asked to end, and it has not ended yet. With security only its owner and "
                  "operators may cancel it; everybody may stop the robot: k",
           key_text({one.goal.writer, one.goal.number}));
    return true;
  });
}

/// Passes a person's typed words to the agent interface.
void Gateway::hear(const Page& page, const Say& words) {
  v1::Utterance utterance =
      situation::typed(node_.instance(), ++utterances_, page.name, words.text, unix_time());
  utterance.person = person_of(page.visitor);
  heard_.write(utterance);
}

void Gateway::send(bus::RequestClient& client, v1::Request request, Connection connection,
                   const Page& page, std::uint64_t reference) {
  request.person = person_of(page.visitor);
  client.send(std::move(request), [this, connection, reference](const v1::Answer& given) {
    std::string id;  // of the artifact that was put
    for (const v1::Argument& result : given.results)
      if (result.name == "id")
        id = format("%.0f", result.number);
    answer(connection, reference, bus::well(given.code), given.text, id);
  });
}

}  // namespace saphira::console
