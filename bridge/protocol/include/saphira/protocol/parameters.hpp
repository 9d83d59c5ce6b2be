#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/geometry/pose.hpp"

namespace saphira::protocol {

struct RobotIdentity;

// A servo's pulses, with some tolerance beyond the usual 1000 to 2000.
inline constexpr int kShortestPulse = 400;  ///< [us]
inline constexpr int kLongestPulse = 2600;  ///< [us]

struct SonarUnit {
  std::uint8_t number = 0;
  Pose pose_in_robot;  ///< of the transducer, looking along its heading

  bool operator==(const SonarUnit&) const = default;
};

/// The generation of the robot's server, which gives the form of the packets and the set of
/// commands.
enum class Protocol {
  kPsos,   ///< Pioneer 1 and AT, as in the manual
  kP2os,   ///< P2OS and AROS: Pioneer 2 and 3, AmigoBot, PeopleBot
  kArcos,  ///< ARCOS: subclasses "...-sh"
};

/// The content of a robot parameter file (manual 3.2 and 10), in SI units. The defaults are the
/// Pioneer 1's, except that there are no sonars.
struct RobotParameters {
  std::string file = {};         ///< where it was read
  std::string name = {};         ///< keyword Name
  std::string robot_class = {};  ///< Class; the second string of the SYNC2 answer
  std::string subclass = {};     ///< Subclass
  /// True for the class and subclass that a robot names, in letters of either case.
  bool is_of(std::string_view of_class, std::string_view of_subclass) const;

  // One unit of the information packet.
  double angle_unit = 0.0061359;      ///< [rad] AngleConvFactor
  double distance_unit = 0.05066e-3;  ///< [m] DistConvFactor
  double velocity_unit = 2.5332e-3;   ///< [m/s] VelConvFactor
  double range_unit = 0.1734e-3;      ///< [m] RangeConvFactor
  /// [rad/m] DiffConvFactor: rotation = (right - left) / 2 * this, of wheel ways or velocities.
  double rotation_per_difference = 3.33333;
  /// [m/s] Vel2Divisor: the unit of the command VEL2.
  double vel2_unit = 0.004;

  // Abilities of the server's generation.
  Protocol protocol = Protocol::kPsos;  ///< Protocol: psos, p2os or arcos
  /// The file gives no Protocol, and the subclass none but p2os: the packets may show arcos.
  bool protocol_is_assumed = false;
  bool move_command = false;            ///< HasMoveCommand; true by itself from p2os on
  bool settable_velocities = false;     ///< SettableVelMaxes; likewise
  bool settable_accelerations = false;  ///< SettableAccsDecs; likewise
  int switch_to_baud = 0;               ///< [baud] SwitchToBaudRate: by HOSTBAUD; 0: never
  double watchdog = 2.0;                ///< [s] Watchdog (manual 5.4.4)

  // Equipment.
  int front_bumpers = 0;  ///< NumFrontBumpers: switches, the left one first
  int rear_bumpers = 0;   ///< NumRearBumpers: likewise, the left one first
  bool gripper = false;   ///< HasGripper
  bool compass = false;   ///< HasCompass
  bool gyro = false;      ///< HasGyro
  bool charger = false;   ///< HasCharger
  // A head that turns the cameras, on the position servo (PTUPOS) of a server whose packets show
  // that.
  double head_reach = 0.0;             ///< [rad] HeadReach, to either side; 0: no head
  double head_center = 1500.0;         ///< [us] HeadCenter: the pulse that looks ahead
  double head_pulse = degrees(6.0);    ///< [us/rad] HeadPulse: of a turn to the left
  double head_speed = radians(120.0);  ///< [rad/s] HeadSpeed, in simulation
  /// [m] EncoderTicksPerMM: the way of one count of an encoder packet; 0: the server has none.
  double encoder_unit = 0.0;
  double low_battery = 11.5;       ///< [V] LowBattery: the server complains
  double shutdown_voltage = 11.0;  ///< [V] ShutdownVolts

  int sonar_arrays = 1;           ///< SonarArrays: arrays fire at the same time, each sonar in turn
  double sonar_period = 0.040;    ///< [s] SonarPeriod: from one firing of an array to its next
  double sonar_max_range = 5.0;   ///< [m] SonarMaxRange: no echo beyond
  double sonar_min_range = 0.05;  ///< [m] SonarMinRange: nearer objects read as this

  double length = 0.0;      ///< [m] RobotLength; 0: the diameter
  double width = 0.0;       ///< [m] RobotWidth; likewise
  double radius = 0.220;    ///< [m] RobotRadius
  double diagonal = 0.090;  ///< [m] RobotDiagonal: half-height to the diagonal of the octagon

  double max_velocity = 0.4;                      ///< [m/s] MaxVelocity
  double max_rotation_velocity = radians(100.0);  ///< [rad/s] MaxRVelocity
  double acceleration = 0.5;                      ///< [m/s2] Acceleration
  double deceleration = 2.0;                      ///< [m/s2] Deceleration
  double rotation_acceleration = radians(300.0);  ///< [rad/s2] RotAcceleration
  double rotation_deceleration = radians(300.0);  ///< [rad/s2] RotDeceleration
  double max_acceleration = 0.0;  ///< [m/s2] MaxAcceleration: the limit of SETA, either way
  double max_rotation_acceleration = 0.0;  ///< [rad/s2] MaxRotAcceleration, of SETRA
  double stop_deceleration = 0.0;          ///< [m/s2] StopDeceleration: the bridge sets it; 0: none
  double stop_rotation_deceleration = 0.0;  ///< [rad/s2] StopRotDeceleration; likewise

  // Errors of the simulated dead reckoning, manual Table 3-1. saphira/sim/robot.hpp gives their use
  // in the simulator.
  double encode_jitter = 0.0;  ///< EncodeJitter
  double angle_jitter = 0.0;   ///< AngleJitter
  double angle_drift = 0.0;    ///< AngleDrift

  double battery = 12.6;         ///< [V] Battery: the voltage that the simulator reports
  int front_buffer = 30;         ///< readings; FrontBuffer
  int side_buffer = 40;          ///< readings of each side; SideBuffer
  double front_max_range = 2.5;  ///< [m] FrontMaxRange (sfFrontMaxRange, manual 6.6.1)

  std::vector<SonarUnit> sonars = {};  ///< SonarNum of them, by number

  /// Harmless oddities, as lines to print ("file:line: ..."): units beyond SonarNum.
  std::vector<std::string> warnings = {};

  bool operator==(const RobotParameters&) const = default;
};

/// [us] The pulse that turns the head to an angle from straight ahead; 0 where there is no head, or
/// where the angle is beyond its reach.
std::uint16_t pulse_of_head(const RobotParameters& parameters, double angle);
/// [rad] The angle of the head at a pulse; 0: straight ahead, or no head.
double angle_of_head(const RobotParameters& parameters, std::uint16_t pulse);

/// True where the server has ESTOP, which brakes harder than a velocity of zero.
inline bool has_emergency_stop(const RobotParameters& parameters) {
  return parameters.protocol != Protocol::kPsos;
}

/// Reads the text of a parameter file; `file` names it in errors. Keywords may stand in any order
/// and case, each at most once; the value may stand on the line behind its keyword. In a file in
/// ARIA's form, with sections, unknown entries are ignored. FileError where the file is wrong,
/// where a required keyword is missing, and where the last line has no line break.
RobotParameters parse_parameters(std::string_view text, const std::string& file);

/// The same from a file.
RobotParameters load_parameters(const std::string& path);

/// The parameter files that fit a robot, the best first (manual 5.4.2): the lower-case subclass, if
/// it has one, and that without its variants (p3dx-sh-lms1xx: p3dx-sh), then the lower-case class,
/// each with ".p". The file of the class Pioneer fits the first generation alone (psos...,
/// pion...): later ones have other units. The strings come from the robot: any that is not a plain
/// file name is left out.
std::vector<std::string> parameter_file_names(std::string_view robot_class,
                                              std::string_view subclass);
/// The first of these files that is in `folder`, if any.
std::optional<std::string> find_parameter_file(const std::string& folder,
                                               std::string_view robot_class,
                                               std::string_view subclass);

/// The parameters of a robot: of `file`, where that is for it (empty: there is none), otherwise of
/// the first file in `folder` that fits. A warning says where it is not the robot's own.
/// std::runtime_error where no file fits or the file has a mistake.
RobotParameters parameters_of(const RobotIdentity& robot, const std::string& folder,
                              const std::string& file = {});

}  // namespace saphira::protocol
