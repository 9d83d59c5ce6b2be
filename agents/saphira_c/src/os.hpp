#pragma once

#include <array>
#include <atomic>
#include <deque>
#include <set>

#include "robot.hpp"
#include "saphira.h"
#include "saphira/behaviors/core.hpp"
#include "saphira/interpretation/core.hpp"
#include "saphira/registration/core.hpp"

namespace saphira::c {

using ::point;  // not the argument of a request

/// The state of the robot for a C program: one whole cycle.
struct View {
  std::uint64_t cycle = 0;
  struct robot robot {};
  std::array<sdata, SF_MAX_SONARS> sonars{};
  std::array<std::uint64_t, SF_MAX_SONARS> read{};  ///< cycle of each sonar's newest reading
  std::array<cbuf, 3> buffers{};                    ///< front, left, right
  std::array<wall, 2> walls{};                      ///< left, right
  std::array<vinfo, 3> vision{};
};

/// The view of the calling thread. The micro-tasks' thread has that of its cycle; any other has a
/// copy of the newest, taken now: so no thread reads while another one writes.
View& view();
/// The calling thread runs the micro-tasks: its view changes in publish() only.
void own_view();
/// A new cycle, from the thread that runs the micro-tasks.
void publish(const View& next);

/// A micro-task or an intention.
struct Task {
  process shown{};
  std::string name;
  bool of_library = false;  ///< a process of the manual's 6.2, or a behavior's place in 8.5
  bool intention = false;
  bool removed = false;
  bool overruled = false;  ///< another thread has set its state during its turn
  std::uint64_t age = 0;   ///< [cycles] of an intention
  std::vector<beh_param> params;
};

/// An instance of a behavior.
struct Closure {
  beh_closure shown{};
  std::string name;    ///< unique
  std::string schema;  ///< of the executive
  bool removed = false;
  std::vector<beh_param> params;
};

/// An artifact on the pointlist, with its last written state.
struct Listed {
  point* artifact = nullptr;
  std::array<float, 3> local{};
  std::array<float, 3> global{};
};

/// The Saphira OS of a C program: the cores of the services, stepped once for each information
/// packet in the order of the micro-tasks, and the program's calls to them.
///
/// The members are under the mutex, except those of the micro-tasks' thread alone. The mutex is
/// never held while a function of the program runs.
class Os {
 public:
  /// The only instance, never destroyed: threads may use it until the end of the process.
  static Os& get();

  // ---- 6.1
  void startup(bool async);
  bool started() const { return started_; }
  bool connect(const std::string& address);
  /// Ends whatever moves the robot.
  void stop_robot();
  void disconnect();
  void pause(int milliseconds);
  bool connected() const { return connected_; }
  bool on_task_thread() const { return std::this_thread::get_id() == task_thread_; }
  /// The program ends: stops the robot. Once.
  void finish();
  void say(const std::string& text, bool error);
  /// The same, from the program: shown to observers too.
  void message(const std::string& text, bool error);

  std::recursive_mutex mutex;
  void (*on_startup)() = nullptr;
  void (*on_connect)() = nullptr;
  void (*on_disconnect)() = nullptr;
  double angle_unit = 1.0;          ///< [rad] of the program's angles of points and of the robot
  bool starts_basic_procs = false;  ///< by itself, with each connection
  std::array<int, 5> display{2, FALSE, FALSE, FALSE, FALSE};  ///< Table 6-1

  // ---- 6.2, 6.5, 8: tasks.cpp
  Task* add(const char* name, void (*fn)(), bool intention);
  Task* find(const std::string& name);
  /// The micro-task of the library with this function; one at the most.
  Task* find(void (*of_library)());
  Task* of(const process* shown);
  void run_tasks();
  /// True for a micro-task of the library that was stopped.
  bool suspended(void (*of_library)());
  // The work of the library's micro-tasks.
  void evaluate_behaviors();
  void interpret();
  void match();
  void find_environment();
  Task* current = nullptr;  ///< of the thread of the micro-tasks

  // ---- 7: closures.cpp
  Closure* add_closure(behavior* b, int priority, bool running, std::vector<beh_param> params,
                       bool duplicate);
  Closure* of(const beh_closure* shown);
  std::deque<std::unique_ptr<Closure>> closures;

  // ---- 6.6: artifacts.cpp
  void add_point(point* p);
  std::vector<Listed> points;
  void update_points();
  void move_robot(const Pose& by);
  bool load_map(const std::string& name);
  void read_map();
  point* find_on_map(int id);

  // ---- The present cycle.
  Pose robot_in_odom;
  Pose odom_in_global;
  Pose robot_in_global() const { return compose(odom_in_global, robot_in_odom); }
  reflector::State state;
  protocol::RobotParameters parameters;
  lps::LocalPerceptualSpace lps;
  std::uint64_t cycle = 0;  ///< since this program began, through all connections

  // ---- 6.4: the wheels' commands, motion.cpp
  reflector::Motion motion;
  double travelled = 0.0;                 ///< [m]
  std::optional<double> position_target;  ///< [m] on that scale
  bool position_dropped = false;          ///< by a stop or a person, before it was reached
  double target_heading = 0.0;            ///< [rad] in odom
  /// Somebody has stopped the robot, and neither sfSetVelocity(0) nor sfStopRobot was called since,
  /// nor have the behaviors begun anew: the motion does not go to the wheels.
  bool stopped = false;
  /// No motion, and not stopped any more.
  void let_go();
  double max_velocity = 0.0;  ///< [m/s] 0: the robot's own
  void send(protocol::Bytes packet);
  /// Shows a state from another source (the packet functions).
  void reflect(const reflector::State& now, const protocol::RobotParameters& robot);

 private:
  Os() = default;
  void run();
  void serve(const std::shared_ptr<Robot>& robot);
  void session_began(const std::shared_ptr<Robot>& robot);
  void session_ended();
  void step(const Reflected& now);
  void hear_stop();
  void give_way(const std::string& driver);
  void go_on_to_position();
  void clamp(const reflector::State& now);
  View shown();
  void show_sonars(View& next);
  void run_task(Task& task);
  void tend_intentions();
  void mind_time(const Task& task, double seconds);
  void watch();
  void reset();
  void share(Robot& robot, std::uint64_t robot_cycle);
  std::optional<SharedMind> mind(std::uint64_t robot_cycle) const;
  void show_map(const maps::Map& map);
  void match_on_bus(const Found& found);

  std::vector<behaviors::Intended> intended();
  behaviors::Intended intended(const Closure& closure);
  void hear_behaviors(const behaviors::Output& output);

  std::atomic<bool> started_{false};
  std::atomic<bool> connected_{false};
  std::atomic<bool> ending_{false};
  std::atomic<bool> idle_{true};
  std::atomic<std::thread::id> task_thread_{};
  std::condition_variable_any changed_;
  std::shared_ptr<Robot> robot_;
  bool wants_robot_ = false;  ///< the connect menu was chosen
  bool explicit_ = false;     ///< the program connects by itself
  std::uint64_t session_ = 0;
  int waits_ = 0;  ///< for a robot

  std::deque<std::unique_ptr<Task>> tasks_;
  std::set<std::string> slow_;  ///< micro-tasks already reported
  struct Watched {
    std::string name;
    double since = 0.0;  ///< [s] 0: no task of the program runs
    bool told = false;
  } watched_;

  // For the thread of the micro-tasks alone.
  std::unique_ptr<behaviors::Core> behaviors_;
  behaviors::Registry schemas_;  ///< for them
  std::unique_ptr<interpretation::Core> interpretation_;
  std::unique_ptr<registration::Core> registration_;
  std::optional<interpretation::Output> percepts_;
  std::shared_ptr<const maps::Map> services_map_;  ///< the newest of the bus
  std::vector<lps::SonarReading> readings_;
  std::uint64_t odom_ = 0;
  bool first_ = true;
  bool new_frame_ = false;
  bool behaviors_began_ = false;
  bool interpretation_began_ = false;
  bool behaviors_drive_ = false;
  int stands_ = 0;  ///< [cycles] on the way to a position
  std::deque<std::pair<double, std::uint64_t>> seen_times_;
  std::uint64_t map_revision_ = 0;
  std::uint32_t environment_ = 0;
  std::vector<std::unique_ptr<wall>> map_points_;
  std::vector<std::unique_ptr<wall>> gone_points_;   ///< a program may have pointers to them
  std::optional<registration::Core::Settings> map_;  ///< to be used from the next cycle on
  std::string behavior_trouble_;
  behaviors::Output behaviors_said_;  ///< in this cycle
  /// Parameters of behaviors that were initialized again in this cycle: an update may be reading
  /// them.
  std::vector<std::vector<beh_param>> replaced_;
};

wall to_c(const maps::Feature& feature);
using behaviors::model_of;
/// Adapters between the executive and the behaviors of the program and the library.
void register_behaviors(behaviors::Registry& registry);
/// Reads "sfFLOAT, 300.0, ..., sfEND". Reports errors in the list, as far as possible.
bool read_arguments(const std::string& function, std::vector<beh_param>& params,
                    std::vector<int>& kinds, va_list list);
/// The parameters' types of one of the library's behaviors.
std::vector<int> kinds_of(const behavior* b);
/// A pose as members of the C API's structures [mm, angle_unit].
void put(const Pose& pose, float& x, float& y, float& th);
inline float real(double value) {
  return static_cast<float>(value);
}
/// For comparing names: letters and digits, in lower case.
std::string bare(std::string_view name);
/// The rectangles and lines that were drawn since the last call.
std::vector<Drawn> take_drawn();

/// Passes typed keys to the program. In the thread of the micro-tasks, once a cycle.
void take_keys();
/// Likewise a place that a person has pointed out [m] [robot], as a click there.
void click(const Vec2& in_robot);
/// Sets the program's sfRobotName, sfRobotClass and sfRobotSubclass.
void show_names(const protocol::RobotIdentity& robot);

}  // namespace saphira::c
