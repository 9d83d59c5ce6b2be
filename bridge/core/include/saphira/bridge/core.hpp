#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "saphira/authority/arbiter.hpp"
#include "saphira/authority/coverage.hpp"
#include "saphira/authority/echo_map.hpp"
#include "saphira/authority/guard.hpp"
#include "saphira/base/archived.hpp"
#include "saphira/bridge/events.hpp"
#include "saphira/bridge/line.hpp"
#include "saphira/protocol/packet.hpp"
#include "saphira/reflector/connection.hpp"
#include "saphira/reflector/reflector.hpp"
#include "saphira/reflector/sweep.hpp"

namespace saphira::bridge {

struct CoreSettings {
  bool lockstep = false;   ///< the robot is a simulator in single step
  bool free_step = false;  ///< lockstep: step without a permit
  double lease = 0.3;      ///< [s] in lockstep cycles x 0.1
  double quiet = std::numeric_limits<double>::infinity();  ///< [s] authority::Settings
  bool guard = true;
  double contact_speed = 0.15;  ///< [m/s] at most, for a driver who wants contact; 0: never
  /// [m] at which the guard stops the hull before an obstacle; authority::Clearance::least at
  /// least.
  double guard_margin = 0.25;
  bool keeps_latches = false;  ///< the latches outlive a restart
  bool vision = false;         ///< the robot's vision system is used
};

/// The bridge without bus, clock, files and sockets. It decides on: the session with the robot, old
/// links and commands, pauses of the bridge's own loop, the driving program, packets to the robot,
/// the status. The caller passes each event with its time, in seconds of a steady clock, and
/// carries out the outputs.
///
/// After each call the caller carries out the outputs of take(), in that order, and then calls
/// work() in the same way until it returns false. A cycle is two such pieces: first its state, so
/// that the services can begin; then everything else.
class Core {
 public:
  explicit Core(const CoreSettings& settings);

  /// The outputs since the last call, in the order of execution.
  std::vector<Output> take() { return std::exchange(out_, {}); }

  // ---- Before the start.

  /// The latches of an earlier run.
  void restore(const authority::Latches& latches);
  /// The odometry of an earlier run.
  void remember(const reflector::OdometryMemory& memory);
  /// The robot is not contacted before this time [s].
  void hold_off(double until) { hold_off_ = until; }

  // ---- The robot's side.

  /// True where the link may be opened.
  bool may_connect(double now) const { return now >= hold_off_; }
  /// The link is not open, or not any more.
  void link_closed(const std::string& why, double now);
  /// Bytes came. work() reads them.
  void received(protocol::ByteView bytes, double now);
  /// Room on the line for requests to the devices [bytes].
  void room(std::size_t bytes) { room_ = bytes; }
  /// Does the next piece of work that is waiting: the rest of a cycle, or the next packet. False
  /// where there is none.
  bool work(double now);
  /// The parameters of the robot named in the event Identified. `epoch`: the least number of the
  /// session.
  void open(const protocol::RobotParameters& parameters, std::uint64_t epoch, double now);
  /// The robot named in the event Identified cannot be served.
  void refuse_robot(const std::string& why, double now);
  /// The time at which the packets before the last Answered were sent.
  void answered(double now);

  // ---- The bus's side.

  void command(const DriveCommand& command, double now);
  /// A writer of motor commands is gone.
  void writer_lost(authority::Role role, const authority::WriterId& writer, double now);
  /// Carries out "stop", "reset" of the emergency stop, or a request to a device
  /// (reflector::functors). Nothing, or an answer that is underway: more follows as LaterAnswer.
  ///
  /// A stop stops every driver at once, with the hardest brakes; whoever drove has to let go, or to
  /// begin anew. Its answer names the stopped drivers; its end follows once the robot has been at
  /// rest.
  std::optional<Answer> request(const Request& request, double now);
  /// Lockstep: the simulator may step while its cycle is less than this.
  void permit(std::uint64_t until_cycle) { permit_ = until_cycle; }
  /// All events that had come were passed on: decides, and answers.
  void answer(double now);
  /// Lockstep: answers the cycle when the behaviors have answered, and lets the simulator step when
  /// it may.
  void step(double now);

  // ---- Time.

  /// The caller's loop came round. After too long a pause, all inputs that waited meanwhile are
  /// old.
  void loop(double now);
  /// Handles everything that depends on time.
  void tick(double now, const Surroundings& around);
  /// The latest time for the next tick [s].
  double due(double now) const;
  /// Ends: stops the robot and releases it.
  void end(double now);

  // ---- The present state.

  /// Epoch 0: no session.
  const v1::Stamp& stamp() const { return session_.stamp; }
  bool in_session() const { return session_.stamp.epoch != 0; }
  /// The driver's answer to the newest packet is expected within a fraction of a millisecond.
  bool awaits_answer() const { return flush_at_ > 0.0; }
  const authority::Grant& grant() const { return grant_; }
  const authority::Latches& latches() const { return arbiter_.latches(); }
  const protocol::RobotParameters& parameters() const { return reflector_.parameters(); }

  /// Between two calls, when the outputs were taken.
  SAPHIRA_ARCHIVE(words_, audit_, parser_, connection_, reflector_, arbiter_, drivers_, guards_,
                  session_, last_epoch_, last_odom_, memory_, slack_, shown_, line_,
                  own_deceleration_, robot_trouble_, permit_, kept_, grant_, told_, guarded_,
                  refused_drivers_, grant_changed_, pressed_, driver_spoke_, expires_at_, flush_at_,
                  stops_, numberless_stops_, room_, last_loop_, last_bytes_, stale_until_,
                  hold_off_, keeper_alive_, keeper_restarts_, keeper_new_until_, reported_at_,
                  wait_, reaction_at_, reaction_sum_, reaction_max_, reactions_, late_, steps_)

 private:
  /// The state of one session with the robot, forgotten at its end.
  struct Session {
    v1::Stamp stamp;
    authority::Body body;
    authority::EchoMap echoes{};
    authority::Coverage coverage{};
    reflector::Sweep sweep;
    Doubts doubts;
    std::uint64_t bad_before = 0;  ///< the parser's count at the start of the session
    double delay = 0.0;            ///< [s] round trip of a slow line; 0: the line is not slow
    double config_asked = 0.0;     ///< [s] the newest question for its configuration
    bool measures = false;         ///< that question measures the delay, and has no answer yet
    double last_packet = 0.0;      ///< [s]
    double last_heard = 0.0;       ///< [s] an information packet, also an impossible one
    bool silent = false;           ///< the link: nobody may drive unseen
    bool configured = false;       ///< it reported its configuration
    bool moved = false;            ///< it was told to move since the newest packet
    bool unheard = false;          ///< it was not heard in motion, repeatedly: it has to stand
    std::optional<std::uint64_t> odom_before;  ///< a cycle has begun, and is to be continued
    bool reacted = true;                       ///< the newest packet was answered
    bool answered = false;                     ///< lockstep: the behaviors answered this cycle
    bool stepping = false;                     ///< lockstep: a STEP is under way
    bool stepped = false;                      ///< lockstep: this cycle was decided and sent
    std::vector<Edge> edges;        ///< [odom] of the behaviors' map near the robot, whoever drives
    std::uint64_t edges_cycle = 0;  ///< in which they came
    unsigned low_battery = 0;       ///< [cycles] without a pause
  };
  /// The newest accepted command of a role.
  struct Driver {
    reflector::Motion motion;
    bool follows_cycles = false;  ///< answers each packet
    double contact_speed = 0.0;   ///< [m/s] for wanted contact
  };
  Driver& driver(authority::Role role) { return drivers_[static_cast<std::size_t>(role)]; }

  double time(double now) const;
  void put(Output output) { out_.push_back(std::move(output)); }
  void info(std::string text) { put(Note{Note::Level::info, std::move(text)}); }
  void warn(std::string text) { put(Note{Note::Level::warning, std::move(text)}); }
  void send(protocol::Bytes bytes) { put(Send{std::move(bytes)}); }

  void tend_session(double now, const Surroundings& around);
  void mind_silence(double now);
  void packet(const protocol::Bytes& body, double now);
  void begin_cycle(const protocol::InformationPacket& packet, double now);
  void finish_cycle(double now);
  void other(protocol::ServerPacket any, std::uint8_t type, double now);
  Answer stop(const Request& request, double now);
  Answer reset_estop(const std::string& source, double now);
  std::optional<Answer> device(const Request& request);
  void reflect(const protocol::ServerPacket& packet, std::uint8_t type);
  void tell_devices();
  std::uint64_t bad_packets() const;
  void heed(const protocol::ConfigPacket& set, double now);
  void mind_brakes();
  void mind_delay(double now);
  void set_delay(double round_trip);
  std::string delay_words() const;
  void lost(const std::string& why, double now, Note::Level level = Note::Level::warning);

  void decide(double now);
  void guard(reflector::Setpoints& wanted);
  /// True where the robot is told to move.
  bool moves() const { return guarded_.velocity != 0.0 || guarded_.rotation_velocity != 0.0; }
  void flush(double now);
  void publish_grant();
  void keep_latches(double now);
  void mind_stops();
  /// Ends the stops of at least that age [cycles].
  void end_stops(AnswerCode code, const std::string& how, std::uint64_t age = 0);

  void mind_keeper(double now, const Surroundings& around);
  bool motors_off() const;
  Condition condition(double now, const Surroundings& around) const;
  Condition robot_condition(double now) const;
  bool has_low_battery() const;
  void report(double now, const Surroundings& around);
  void tell_wait(const Condition& now_is, double now);

  CoreSettings settings_;
  std::vector<Output> out_;
  Notes words_;                        ///< to be put out when the packets are out
  std::vector<v1::AuditEntry> audit_;  ///< likewise

  protocol::PacketParser parser_;
  reflector::Connection connection_;
  reflector::Reflector reflector_;
  authority::Arbiter arbiter_;
  std::array<Driver, 5> drivers_;                   ///< by role
  std::array<authority::GuardSettings, 5> guards_;  ///< by role
  Session session_;

  // State that outlives a session.
  std::uint64_t last_epoch_ = 0;
  std::uint64_t last_odom_ = 0;
  std::optional<reflector::OdometryMemory> memory_;
  reflector::Slack slack_;
  /// The fields of the information packet that are told with the devices.
  std::tuple<std::uint8_t, std::uint8_t, std::optional<bool>, std::optional<bool>,
             std::optional<std::uint16_t>, std::optional<std::uint8_t>, std::optional<double>,
             std::optional<double>, std::uint8_t, std::optional<double>>
      shown_;
  Line line_;
  double own_deceleration_ = 0.0;  ///< [m/s2] from its parameter file
  std::string robot_trouble_;      ///< why a connected robot is not served
  std::uint64_t permit_ = 0;       ///< lockstep
  authority::Latches kept_;        ///< as they were put out last

  // The present decision.
  authority::Grant grant_;
  DriverSetpoints told_;
  authority::Guarded guarded_;
  std::set<std::string> refused_drivers_;  ///< in the audit since the driver changed
  bool grant_changed_ = false;
  bool pressed_ = false;       ///< the emergency stop, since answer()
  bool driver_spoke_ = false;  ///< the present driver, since the last answer
  double expires_at_ = 0.0;    ///< [s] end of the present driver's lease
  double flush_at_ = 0.0;      ///< [s] time to send without the driver's answer; 0: none
  struct Stopping {
    std::uint64_t asker = 0;
    std::uint64_t number = 0;
    std::string stopped;      ///< the stopped drivers, in words
    std::uint64_t cycle = 0;  ///< of the stop
    double asked = 0.0;       ///< [s]
  };
  std::vector<Stopping> stops_;  ///< until the robot is at rest
  std::uint64_t numberless_stops_ = 0;

  std::size_t room_ = SIZE_MAX;
  std::optional<double> last_loop_;  ///< [s]
  double last_bytes_ = 0.0;          ///< [s]
  double stale_until_ = 0.0;         ///< [s] inputs before this time waited during a gap
  double hold_off_ = 0.0;            ///< [s] the robot is not contacted before this time

  // The status.
  bool keeper_alive_ = true;
  int keeper_restarts_ = 0;
  double keeper_new_until_ = 0.0;  ///< [s] the status tells that the keeper was replaced
  double reported_at_ = 0.0;       ///< [s]
  struct Wait {
    std::string reason;
    double since = 0.0;  ///< [s]
    bool told = false;
  };
  Wait wait_;                  ///< for the robot
  double reaction_at_ = 0.0;   ///< [s]
  double reaction_sum_ = 0.0;  ///< [s]
  double reaction_max_ = 0.0;  ///< [s]
  int reactions_ = 0;
  std::uint64_t late_ = 0;
  std::uint64_t steps_ = 0;
};

}  // namespace saphira::bridge
