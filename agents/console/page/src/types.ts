// The members of idl/*.idl that the page reads, as the gateway writes them: JSON, enumerators by name.
export interface Pose { x: number; y: number; th: number }
export interface Stamp { epoch: number; cycle: number }

export interface RobotState {
  stamp: Stamp;
  odom: number;
  pose_in_odom: Pose;
  velocity: number;
  rotation_velocity: number;
  target_velocity: number;
  target_heading_in_odom: number;
  head: number;
  status: string;
  left_stalled: boolean;
  right_stalled: boolean;
  battery: number;
  sonars: {sonar: number; range: number; echo: boolean}[];
  motor_packets_per_s: number;
  sonar_readings_per_s: number;
  vision_packets_per_s: number;
  bad_packets: number;
}
export interface RobotDescription {
  name: string;
  robot_class: string;
  radius: number;
  diagonal: number;
  max_velocity: number;
  max_rotation_velocity: number;
  head_reach: number;
  sonars: {sonar: number; pose_in_robot: Pose}[];
}
export interface Grant {
  stamp: Stamp;
  role: string;
  source: string;
  reason: string;
  command_age: number;
  guard: string;
  guard_reason: string;
  velocity: number;
  estopped: boolean;
  estop_source: string;
  waits_for_hand_back: boolean;
}
export interface Devices { has_charge: boolean; charge: number; charging: number }
export interface Registration {
  state: string;
  reason: string;
  odom: number;
  pose_in_map: Pose;
  odom_in_map: Pose;
  covariance: {xx: number; xy: number; yy: number; thth: number};
  confidence: number;
  closed_doors: number[];
}
export interface Percept {
  id: number;
  type: string;
  pose_in_odom: Pose;
  length: number;
  width: number;
  confidence: number;
}
export interface Perception { odom: number; percepts: Percept[] }
export interface Vision {
  stamp: Stamp;
  odom: number;
  things: {id: number; kind: string; pose_in_odom: Pose; velocity_x: number; velocity_y: number;
           range_known: boolean; confidence: number; points: number; pointed: number}[];
}
export interface GridTile {
  column: number;
  row: number;
  odom: number;
  resolution: number;
  side: number;
  cells: number[];
}
export interface MapArtifact {
  id: number;
  type: string;
  pose_in_map: Pose;
  length: number;
  width: number;
  name: string;
  learned: boolean;
  rule: string;    // of a zone
  speed: number;
}
export interface SaphiraMap { revision: number; source: string; changed: boolean; artifacts: MapArtifact[] }
export interface Argument { name: string; kind: string; number: number; text: string; point: Pose; frame: string }
export interface Goal { requester: string; functor: string; arguments: Argument[]; priority: number; withdrawn: string }
export interface GoalId { writer: number; number: number }   // as near as a number can be
export interface GoalStatus {
  stamp: Stamp;
  requester: string;
  functor: string;
  state: string;
  reason: string;
  step: string;
  progress: number;
  elapsed: number;
  code: string;
  note: string;
  waits_for: GoalId;         // the goal in front of this one, or the one that stopped it [0, 0: none]
}
export interface Rule { name: string; strength: number; action: string; value: number }
export interface BehaviorState {
  name: string;
  schema: string;
  priority: number;
  running: boolean;
  turn_activity: number;
  speed_activity: number;
  turn_weight: number;
  speed_weight: number;
  goal: number;
  progress: number;
  recommends_turn: boolean;
  turn: number;
  recommends_speed: boolean;
  speed: number;
  rules: Rule[];
  areas: {x_from: number; x_to: number; y_from: number; y_to: number}[];
}
export interface Behaviors {
  control: boolean;
  behaviors: BehaviorState[];
  turning: boolean;
  turn: number;
  moving: boolean;
  speed: number;
  limit_reason: string;
  missing: {name: string; reason: string}[];
  trouble: string;
}
export interface IntentionNode {
  id: number;
  parent: number;
  name: string;
  schema: string;
  arguments: string;
  state: string;
  blocking: boolean;
  label: string;
  step: string;
  goal?: GoalId;
}
export interface Intentions { nodes: IntentionNode[] }
export interface ActivityParameter { name: string; kind: string; unit: string; required: boolean; usual: string }
export interface ActivitySchemas { schemas: {name: string; summary: string; parameters: ActivityParameter[]}[]; trouble: string }
export interface ProgramMind { source: string; behaviors: Behaviors; intended: Intentions }
export interface Cause { kind: string; text: string; because: Cause[] }
export interface Why { epoch: number; cycle: number; sentence: string; tree: Cause }
export interface ServiceStatus {
  name: string;
  host: string;
  state: string;
  reason: string;
  late_cycles: number;
  step_ms_mean: number;
  cpu_percent: number;
  rss_mb: number;
}
export interface Processes { service: string; processes: {name: string; state: string; number: number; effect: string}[] }
export interface Belief { name: string; value: string; said_by: string }
export interface Message { source: string; text: string }
export interface Utterance { speaker: string; text: string; time: number }
export interface LogRecord { name: string; level: string; text: string; time_ns: number }
export interface Drawing {
  source: string;
  frame: string;
  odom: number;
  shape: string;
  points: {x: number; y: number}[];
  text: string;
  red: number;
  green: number;
  blue: number;
  width: number;
  lifetime: number;
}
export interface ControlState { holder: number; name: string; asked: {id: number; name: string}[]; note: string; let_go: string }   // let_go: why it must be let go first [empty: it need not]
// A robot of the list [does silent: no state is heard; trouble: why it cannot be joined].
export interface RobotRow {
  name: string;
  own: boolean;
  does: 'silent' | 'stopped' | 'drives' | 'stands';
  trouble: string;
  why: string;
  host: string;
  address: string;
  velocity?: number;
  battery?: number;
  role?: string;
  who?: string;
}
export interface ConsoleInfo { robot: string; host: string; simulator: boolean }
// How old the picture is [ms]; gone: the link, silent: no robot was ever heard.
export interface Seen { state: 'live' | 'old' | 'silent' | 'gone' | 'locked'; age: number }
