#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "box.hpp"
#include "cameras.hpp"
#include "dialer.hpp"
#include "key.hpp"
#include "robots.hpp"
#include "saphira/bus/audit.hpp"
#include "saphira/bus/goal_client.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/console/board.hpp"
#include "saphira/console/detour.hpp"
#include "saphira/console/message.hpp"
#include "saphira/teleop/control.hpp"
#include "saphira/teleop/pilot.hpp"
#include "saphira/watch/mind.hpp"
#include "server.hpp"
#include "simulator_link.hpp"

namespace saphira::console {

struct GatewayOptions {
  ServerOptions server;
  std::vector<std::string> names;  ///< further host names of this machine
  bool always_key = false;         ///< for watching from this machine, too
  std::vector<std::string> person_keys = security::door_key_files();
  std::string simulator;               ///< socket of a simulator's own view; empty: none
  std::optional<relay::Address> dial;  ///< a relay for further access
  std::string dial_token;              ///< our token there
  std::string dial_authority;          ///< PEM file to check its certificate
  std::string box;                     ///< folder for the last minute after an event; empty: none
  std::string key_file;  ///< keeps key and port over a restart; empty: a new key each time
  /// While no port is free the status says so, and it is tried again, until this stop; none: that
  /// is an error at once.
  const bus::Stop* stop = nullptr;
};

/// [s] of the clock of these files.
double now();
/// A key, in the board's form.
std::string key_text(const bus::InstanceKey& key);
/// The name of a page's operator for the rest of the system.
std::string operator_of(const std::string& name);

/// Between the bus and the browsers: samples of the bus go onto the board, the pages' messages go
/// to the bus. For one thread.
class Gateway {
 public:
  Gateway(const bus::NodeOptions& node, const GatewayOptions& options);

  int run(const bus::Stop& stop);
  /// The address that a person opens, with the key.
  std::string address() const;

 private:
  Gateway(const bus::NodeOptions& node, const GatewayOptions& options, const Kept& kept);
  /// The server, when it has a place to listen on.
  Server opened(const GatewayOptions& options, const Kept& kept);

  using Connection = Server::Connection;

  struct Page {
    Channel channel = Channel::telemetry;
    Caller caller;
    bool greeted = false;        ///< it has sent hello, and may watch
    Visitor visitor;             ///< by its key
    std::string name;            ///< of the operator
    std::string ticket;          ///< joins a further connection to this operator's samples
    Connection operator_id = 0;  ///< the operator of the samples of this connection [0: none]
    double opened = 0.0;         ///< [s]
    Viewer viewer;
    std::shared_ptr<PictureFlow> flow;  ///< pictures
    std::deque<std::string> queue;      ///< commands: outgoing messages
    std::uint64_t world = 0;            ///< simulator: newest version that was sent
    std::uint64_t scene = 0;            ///< likewise
    std::string refused;                ///< the newest reason for a refused sample
    bool robots = false;                ///< it shows the list of robots
    Upload upload;
  };
  struct Canceling {
    Connection connection = 0;
    std::uint64_t reference = 0;
    v1::GoalId goal;
    double until = 0.0;  ///< [s] for its end
  };

  Server::Events events();
  template <class T>
  int feed(const bus::Topic<T>& topic, std::size_t most = 1, bool with_writer = false);
  void feed_all();
  void poll();
  void tick();
  void drive();
  void press_estop();
  void explain();
  void look_for_occasions();
  void show_control();
  void show_page(const std::string& address);
  void detour();
  std::vector<RobotSeen> robots_seen() const;
  void show_robots();
  void stop_robots(Connection connection, const Page& page, const StopRobots& stop);
  void look_at_simulator();
  void look_at_cameras();
  void ask_simulator(Connection connection, const Page& page, std::string text);

  void opened(Connection connection, Channel channel, const Caller& caller);
  bool came(Connection connection, const std::string& text);
  void closed(Connection connection);
  std::optional<std::string> next(Connection connection);

  bool greet(Connection connection, Page& page, const Hello& hello);
  void name(Connection connection, Page& page, const std::string& name);
  void admit(Connection connection, Page& page, const Hello& hello);
  void share_pictures(Connection connection, Page& page, const std::string& ticket);
  void look_at_keys();
  void obey(Connection connection, Page& page, const Message& message);
  void take_sample(Connection connection, Page& page, const teleop::Control::Sample& sample);
  void ask_goal(Connection connection, const Page& page, const AskGoal& ask);
  void save_map(Connection connection, const SaveMap& save);
  void load_map(Connection connection, Page& page, const LoadMap& piece);
  void change_map(Connection connection, const Page& page, const ChangeMap& change);
  void cancel_goal(Connection connection, const Page& page, const CancelGoal& cancel);
  void tell_cancels();
  void hear(const Page& page, const Say& words);
  void hand_back(Connection connection);
  void say(Connection connection, std::string text);
  void answer(Connection connection, std::uint64_t reference, bool well, const std::string& text,
              const std::string& id = {});
  void send(bus::RequestClient& client, v1::Request request, Connection connection,
            const Page& page, std::uint64_t reference);

  AccessSettings access_;
  security::DoorKeysFile keys_;
  std::string origin_;
  bus::Node node_;
  Board board_;
  teleop::Control control_;
  teleop::Pilot pilot_{"console"};
  watch::Mind mind_{node_, false};
  bus::GoalClient goals_{node_, "console"};
  bus::RequestClient stops_{node_, bus::topics::kDriveStop, "console"};
  bus::RequestClient resets_{node_, bus::topics::kEstopReset, "console"};
  bus::RequestClient registration_{node_, bus::topics::kRegistrationRequest, "console"};
  bus::RequestClient processes_{node_, bus::topics::kProcessRequest, "console"};
  bus::Writer<v1::MotorCommand> teleop_ = node_.writer(bus::topics::kDriveTeleop);
  bus::Writer<v1::MotorCommand> estop_ = node_.writer(bus::topics::kDriveEstop);
  bus::Writer<v1::Utterance> heard_ = node_.writer(bus::topics::kHeard);
  bus::Writer<v1::AgentEvent> pointed_out_ = node_.writer(bus::topics::kAgentEvents);
  bus::Writer<v1::ConsolePage> own_page_ = node_.writer(bus::topics::kPage);
  watch::Newest<v1::FloorMap> map_{node_, bus::topics::kMap};
  bus::Audit audit_{node_};

  std::vector<std::function<bool()>> feeds_;  ///< each: true where it had new samples
  std::vector<int> detoured_;                 ///< topics
  int control_topic_ = 0;
  int robots_topic_ = 0;
  int why_topic_ = 0;
  std::map<Connection, Page> pages_;
  std::vector<Canceling> canceling_;
  int viewers_ = 0;
  std::uint64_t events_ = 0;

  v1::Stamp stamp_;             ///< of the newest robot state
  double robots_shown_ = -1e9;  ///< [s]
  std::uint64_t utterances_ = 0;
  double explained_ = -1e9;  ///< [s]
  situation::Occasions occasions_;
  double looked_ = -1e9;  ///< [s] for occasions
  bus::Writer<v1::Message> messages_ = node_.writer(bus::topics::kMessages);
  std::optional<Box> box_;
  std::string shown_control_;
  Detour detour_;
  std::string why_;  ///< the newest sentence
  Robots robots_{node_};
  std::string shown_robots_;
  Cameras cameras_{node_};
  std::optional<SimulatorLink> simulator_;

  Server server_;
  std::optional<Dialer> dialer_;
};

}  // namespace saphira::console
