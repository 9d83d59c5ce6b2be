#include "gateway.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "saphira/base/boot_clock.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/program.hpp"
#include "saphira/situation/why.hpp"

namespace saphira::console {

namespace {

namespace topics = bus::topics;

constexpr double kGreeting = 5.0;     // [s] limit for a page's hello
constexpr double kExplain = 0.5;      // [s]
constexpr double kListenAgain = 3.0;  // [s]
constexpr std::size_t kLines = 200;   // of a log
constexpr std::size_t kMany = 2000;   // instances of a topic

ServerOptions server_of(const GatewayOptions& options, const Kept& kept) {
  ServerOptions server = options.server;
  server.before = kept.port;
  server.relayed = options.dial.has_value();
  return server;
}

AccessSettings access_of(const GatewayOptions& options, const Kept& kept) {
  AccessSettings access{kept.key, options.names, 0, options.always_key};
  access.names.push_back(web::host_name());
  access.names.push_back(web::host_name() + ".local");
  if (options.dial)
    access.names.push_back(options.dial->host);
  return access;
}

/// The page lists the other robots.
bus::NodeOptions among_robots(bus::NodeOptions options) {
  options.others = bus::Others::noted;
  return options;
}

}  // namespace

double now() {
  return BootClock::seconds();  // commands from before the machine slept are not valid now
}

std::string key_text(const bus::InstanceKey& key) {
  return format("%llx:%llx", static_cast<unsigned long long>(key[0]),
                static_cast<unsigned long long>(key[1]));
}

std::string operator_of(const std::string& name) {
  return (name.empty() ? "somebody" : name) + " at the console";
}

Gateway::Gateway(const bus::NodeOptions& node, const GatewayOptions& options)
    : Gateway(node, options, keep(options.key_file)) {}

Gateway::Gateway(const bus::NodeOptions& node, const GatewayOptions& options, const Kept& kept)
    : access_(access_of(options, kept)),
      keys_(options.person_keys),
      origin_((options.server.place.certificate.empty() ? "http://" : "https://") +
              web::name_of(options.server.place)),
      node_(among_robots(node)),
      server_(opened(options, kept)) {
  access_.port = server_.port();
  keep_port(options.key_file, kept, access_.port);
  look_at_keys();
  feed_all();
  board_.put(board_.topic("console"), "",
             "{\"robot\":" + quoted(node.robot) + ",\"host\":" + quoted(web::host_name()) +
                 ",\"simulator\":" + (options.simulator.empty() ? "false" : "true") + "}",
             now());
  if (!options.simulator.empty())
    simulator_.emplace(options.simulator);
  if (!options.box.empty())
    box_.emplace(options.box, node);
  show_control();
  show_page(origin_ + ":" + std::to_string(server_.port()) + "/");
  server_.watch(node_.wake_fd());
  if (options.dial)
    dialer_.emplace(
        DialOptions{*options.dial, options.dial_token, options.dial_authority,
                    server_.relayed_port()},
        [this, host = options.dial->host, key = access_.key](int port) {
          const std::string page = format("https://%s:%d/", host.c_str(), port);
          show_page(page);
          std::printf("open %s#%s\n", page.c_str(), key.c_str());
          std::fflush(stdout);
        },
        [host = options.dial->host](const std::string& why) {
          std::fprintf(stderr, "the relay %s is not reached (%s); it is dialled again and again\n",
                       host.c_str(), why.c_str());
        });
}

Server Gateway::opened(const GatewayOptions& options, const Kept& kept) {
  while (true) {
    try {
      return Server(server_of(options, kept), access_, page_files(), events());
    } catch (const std::runtime_error& error) {
      if (options.stop == nullptr || options.stop->requested())
        throw;
      if (node_.status().reason != error.what())
        node_.error(error.what());
      node_.status().state = v1::SERVICE_WAITING;
      node_.status().reason = error.what();
    }
    // A status a second.
    for (const double until = now() + kListenAgain; now() < until && !options.stop->requested();) {
      node_.publish_status();
      node_.wait(std::chrono::milliseconds(200), options.stop);
    }
  }
}

Server::Events Gateway::events() {
  return {[this](auto connection, auto channel, const auto& caller) {
            opened(connection, channel, caller);
          },
          [this](auto connection, const auto& text) { return came(connection, text); },
          [this](auto connection) { closed(connection); },
          [this](auto connection) { return next(connection); },
          [this] {
            node_.clear_wake();
            if (!pages_.empty())  // else the next tick takes the samples of all topics at once
              poll();
          },
          [this] { tick(); }};
}

std::string Gateway::address() const {
  return origin_ + ":" + std::to_string(server_.port()) + "/#" + access_.key;
}

/// Also from the dialer's thread: people reach the page by the relay from everywhere.
void Gateway::show_page(const std::string& address) {
  own_page_.write({.instance = node_.instance(), .host = web::host_name(), .address = address});
}

/// with_writer: an instance is there as long as its writer.
template <class T>
int Gateway::feed(const bus::Topic<T>& topic, std::size_t most, bool with_writer) {
  const int rank = board_.topic(topic.name, most);
  auto reader = std::make_shared<bus::Reader<T>>(node_.reader(topic));
  feeds_.push_back([this, rank, reader, with_writer, topic] {
    const bus::TypeInfo& type = bus::type_of<T>();
    const auto owner = [](const bus::WriterId& writer) {
      return std::string(writer.begin(), writer.end());
    };
    bool any = false;
    reader->visit([&](const T& sample, const bus::SampleInfo& info) {
      any = true;
      // Without a viewer, cyclic samples are not kept: the next ones come within 0.1 s.
      if (viewers_ == 0 && topic.qos == bus::Qos::cyclic)
        return;
      std::string key = type.keyed ? key_text(type.key(&sample)) : std::string();
      if (topic.qos == bus::Qos::event) {
        key = format("%020llu", static_cast<unsigned long long>(++events_));
      }
      if (info.disposed) {
        board_.withdraw(rank, key);
        return;
      }
      board_.put(rank, key, type.json(&sample, ""), now(),
                 with_writer ? owner(info.writer) : std::string());
    });
    for (const bus::WriterId& writer : reader->take_lost()) {
      board_.lose(rank, owner(writer));
      any = true;
    }
    return any;
  });
  return rank;
}

/// The topics in the order of a page's needs: on a slow link the later ones wait.
void Gateway::feed_all() {
  detoured_ = {feed(topics::kRobotState), feed(topics::kGrant)};
  control_topic_ = board_.topic("console/control");
  board_.urgent_so_far();
  feed(topics::kRobotDescription);
  feed(topics::kRegistration);
  feed(topics::kDevices);
  feed(topics::kPerception);
  feed(topics::kVision);
  feed(topics::kGoals, kMany, true);
  feed(topics::kGoalStatus, kMany);
  feed(topics::kIntentions);
  feed(topics::kBehaviors);
  feed(topics::kProgramMinds, kMany, true);
  why_topic_ = board_.topic("why");
  feed(topics::kMap);
  feed(topics::kMessages, kLines);
  feed(topics::kHeard, kLines);
  feed(topics::kSaid, kLines);
  feed(topics::kStatus, kMany);
  feed(topics::kDrawings, kMany, true);
  feed(topics::kProcesses, kMany, true);
  feed(topics::kBeliefs);
  feed(topics::kActivitySchemas);
  robots_topic_ = board_.topic("robots");
  feed(topics::kGrid, kMany, true);
  feed(topics::kLog, kLines);
}

int Gateway::run(const bus::Stop& stop) {
  node_.status().state = v1::SERVICE_RUNNING;
  node_.status().reason.clear();
  server_.run(stop.fd());
  return bus::kExitOk;
}

void Gateway::poll() {
  bool any = false;
  for (const auto& take : feeds_)
    any = take() || any;
  mind_.poll();
  goals_.poll();
  for (bus::RequestClient* client : {&stops_, &resets_, &registration_, &processes_})
    client->poll(now());
  tell_cancels();
  if (const v1::RobotState* const robot = mind_.robot()) {
    const bool is_new = robot->stamp.cycle != stamp_.cycle;
    stamp_ = robot->stamp;
    if (is_new)
      detour();
    cameras_.heard(stamp_.cycle, now());
  }
  any = cameras_.poll(now()) || any;
  map_.poll();
  if (any)
    server_.want_all_soon();
}

void Gateway::look_at_simulator() {
  if (!simulator_ || !simulator_->poll(now()))
    return;
  const std::vector<std::string> troubles = simulator_->take_troubles();
  for (auto& [connection, page] : pages_) {
    if (page.channel != Channel::simulator || !page.greeted)
      continue;
    for (const std::string& trouble : troubles)
      say(connection, trouble);
    server_.want(connection);
  }
}

void Gateway::look_at_cameras() {
  cameras_.set_watched(std::ranges::any_of(pages_, [](const auto& each) {
    return each.second.channel == Channel::pictures && each.second.greeted;
  }));
}

void Gateway::tick() {
  look_at_cameras();
  poll();
  look_at_keys();
  audit_.tend(now());
  look_at_simulator();
  drive();
  press_estop();
  explain();
  look_for_occasions();
  show_control();
  show_robots();
  for (const auto& [connection, page] : pages_)
    if (!page.greeted && now() - page.opened > kGreeting)
      server_.close(connection);
  node_.status().stamp = stamp_;
  node_.publish_status();
}

void Gateway::drive() {
  teleop::Order order = control_.order(now());
  if (!order.source.empty())
    order.source = operator_of(order.source);
  if (const auto command = pilot_.drive(order, stamp_))
    teleop_.write(*command);
}

void Gateway::press_estop() {
  const v1::Grant* const grant = mind_.grant();
  if (const auto command = pilot_.stop(grant != nullptr && grant->estopped))
    estop_.write(*command);
}

/// The reasons for the robot's motion, as in `saphira why`.
void Gateway::explain() {
  if (viewers_ == 0 || now() - explained_ < kExplain || !mind_.heard())
    return;
  explained_ = now();
  const situation::Explanation why = situation::why(mind_.situation());
  why_ = why.sentence;
  board_.put(why_topic_, "", situation::to_json(why), now());
}

std::vector<RobotSeen> Gateway::robots_seen() const {
  std::vector<RobotSeen> seen = robots_.seen();
  seen.insert(seen.begin(), {.name = node_.options().robot,
                             .own = true,
                             .age = mind_.silence(),
                             .robot = mind_.robot(),
                             .grant = mind_.grant(),
                             .why = why_});
  return seen;
}

void Gateway::show_robots() {
  if (viewers_ > 0)
    robots_.find(std::ranges::any_of(pages_, [](const auto& each) { return each.second.robots; }),
                 now());
  robots_.poll(now());
  if (now() - robots_shown_ < kExplain)
    return;
  robots_shown_ = now();
  const std::string text =
      "[" + joined(robots_seen(), ",", [](const RobotSeen& seen) { return to_json(seen); }) + "]";
  if (text == shown_robots_)
    return;
  shown_robots_ = text;
  board_.put(robots_topic_, "", text, now());
}

/// Tells the pages of an event; the last minute after it goes into the box.
void Gateway::look_for_occasions() {
  if (box_)
    if (const auto text = box_->poll(control_.holder() != 0, now()))
      messages_.write({.stamp = stamp_, .source = "console", .text = *text});
  if ((!box_ && pages_.empty()) || now() - looked_ < kExplain || !mind_.heard())
    return;
  looked_ = now();
  const auto occasion = occasions_.next(mind_.situation(), looked_);
  if (!occasion)
    return;
  if (box_)
    box_->keep(*occasion, looked_);
  for (const auto& [connection, page] : pages_)
    if (page.channel == Channel::commands && page.greeted &&
        (page.operator_id == 0 || page.operator_id == connection))  // once to a page
      say(connection, "{\"type\":\"event\",\"text\":" + quoted(occasion->text) + "}");
}

/// The operator's connections in turn: each has an answer to a sample only.
void Gateway::detour() {
  if (control_.holder() == 0 || !detour_.wanted(now()))
    return;
  std::vector<Connection> ways;
  for (const auto& [connection, page] : pages_)
    if (page.operator_id == control_.holder() && page.queue.empty())
      ways.push_back(connection);
  if (!ways.empty())
    say(ways[stamp_.cycle % ways.size()],
        "{\"type\":\"state\"," + board_.members(detoured_, now()) + "}");
}

void Gateway::show_control() {
  std::string text = to_json(control_.state());
  if (text == shown_control_)
    return;
  shown_control_ = text;
  board_.put(control_topic_, "", std::move(text), now());
}

}  // namespace saphira::console
