/* An agent in C on Cyclone DDS: looks at the robot, sends it to a point and follows that, takes the
 * goal back, drives it by hand.
 *
 *   c_agent state              the robot's state for a second
 *   c_agent go X Y             to the point [m in odom]; exit code 0 when it is there
 *   c_agent cancel X Y SECONDS the same, and takes the goal back after so long
 *   c_agent drive SPEED TURN SECONDS   [m/s], [rad/s]
 *
 * SAPHIRA_ROBOT and SAPHIRA_DOMAIN say which robot. Without CYCLONEDDS_URI it speaks on this machine
 * alone, as the profile host does.
 *
 * Besides the types, a program on another vendor's DDS needs two things: the robot's name as its
 * partition, and the QoS of each topic (idl/README.md). Both are in reader_of and writer_of below.
 */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dds/dds.h"
#include "intention.h"
#include "motion.h"
#include "robot.h"

static const char* const kThisMachine =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address='127.0.0.1' "
    "multicast='true'/></Interfaces></General><Discovery><Ports><Base>7525</Base></Ports>"
    "</Discovery></Domain></CycloneDDS>";

static volatile sig_atomic_t stopped = 0;
static void stop(int number) {
  (void)number;
  stopped = 1;
}

static dds_entity_t participant;
static uint64_t self; /* random: ids of goals are unique for ever */

static void check(dds_return_t code, const char* what) {
  if (code >= 0) return;
  fprintf(stderr, "c_agent: %s: %s\n", what, dds_strretcode(-code));
  exit(3);
}

static const char* robot_name(void) {
  const char* name = getenv("SAPHIRA_ROBOT");
  return name == NULL || *name == '\0' ? "pioneer" : name;
}

/* The rows of the QoS table that this agent needs. */
enum qos { CYCLIC, MOTION, GOAL, LATCHED };

static dds_qos_t* qos_of(enum qos name, bool reader) {
  dds_qos_t* qos = dds_create_qos();
  const bool reliable = name == GOAL || name == LATCHED;
  const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_reliability(qos, reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_SECS(1));
  dds_qset_durability(qos, reliable ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, reader && name == LATCHED ? 8 : reader ? 4 : 1);
  dds_qset_data_representation(qos, 1, &xcdr1);
  return qos;
}

static const char* const* partition(void) {
  static const char* names[1];
  names[0] = robot_name();
  return names;
}

static dds_entity_t reader_of(const dds_topic_descriptor_t* type, const char* topic, enum qos qos) {
  dds_qos_t* group = dds_create_qos();
  dds_qset_partition(group, 1, (const char**)partition());
  const dds_entity_t subscriber = dds_create_subscriber(participant, group, NULL);
  check(subscriber, "subscriber");
  const dds_entity_t entity = dds_create_topic(participant, type, topic, NULL, NULL);
  check(entity, topic);
  dds_qos_t* own = qos_of(qos, true);
  const dds_entity_t reader = dds_create_reader(subscriber, entity, own, NULL);
  check(reader, topic);
  dds_delete_qos(own);
  dds_delete_qos(group);
  return reader;
}

static dds_entity_t writer_of(const dds_topic_descriptor_t* type, const char* topic, enum qos qos) {
  dds_qos_t* group = dds_create_qos();
  dds_qset_partition(group, 1, (const char**)partition());
  const dds_entity_t publisher = dds_create_publisher(participant, group, NULL);
  check(publisher, "publisher");
  const dds_entity_t entity = dds_create_topic(participant, type, topic, NULL, NULL);
  check(entity, topic);
  dds_qos_t* own = qos_of(qos, false);
  /* A goal is withdrawn by disposing it; the end of its writer withdraws it as well. */
  dds_qset_writer_data_lifecycle(own, true);
  const dds_entity_t writer = dds_create_writer(publisher, entity, own, NULL);
  check(writer, topic);
  dds_delete_qos(own);
  dds_delete_qos(group);
  return writer;
}

/* The next sample of a reader into *sample, which is NULL the first time; false: none. */
static bool take(dds_entity_t reader, void** sample) {
  dds_sample_info_t info;
  do {
    if (*sample != NULL) dds_return_loan(reader, sample, 1);
    *sample = NULL;
    if (dds_take(reader, sample, &info, 1, 1) <= 0) return false;
  } while (!info.valid_data);
  return true;
}

static int state(void) {
  const dds_entity_t reader = reader_of(&saphira_v1_RobotState_desc, "robot/state", CYCLIC);
  int shown = 0;
  for (int i = 0; i < 100 && shown < 10 && !stopped; ++i) {
    void* sample = NULL;
    while (shown < 10 && take(reader, &sample)) {
      const saphira_v1_RobotState* robot = sample;
      printf("cycle %llu at (%.2f, %.2f) %.0f degrees, %.2f m/s, %u sonars read\n",
             (unsigned long long)robot->stamp.cycle, robot->pose_in_odom.x, robot->pose_in_odom.y,
             robot->pose_in_odom.th * 180.0 / 3.14159265, robot->velocity, robot->sonars._length);
      ++shown;
    }
    dds_sleepfor(DDS_MSECS(100));
  }
  if (shown == 0) fprintf(stderr, "c_agent: nothing is heard of robot %s\n", robot_name());
  return shown > 0 ? 0 : 1;
}

static bool ended(saphira_v1_GoalState s) {
  return s == saphira_v1_GOAL_REFUSED || s == saphira_v1_GOAL_SUCCEEDED ||
         s == saphira_v1_GOAL_FAILED || s == saphira_v1_GOAL_CANCELED;
}

static const char* const kStates[] = {"waiting",   "refused", "underway", "suspended",
                                      "succeeded", "failed",  "canceled"};

static int go(double x, double y, double take_back) {
  const dds_entity_t goals = writer_of(&saphira_v1_Goal_desc, "goals", GOAL);
  const dds_entity_t statuses = reader_of(&saphira_v1_GoalStatus_desc, "goals/status", LATCHED);
  saphira_v1_Argument position = {.name = "position",
                                  .kind = saphira_v1_ARGUMENT_POINT,
                                  .text = "",
                                  .point = {.x = x, .y = y},
                                  .frame = saphira_v1_FRAME_ODOM};
  saphira_v1_Goal goal = {.id = {.writer = self, .number = 1},
                          .requester = "c_agent",
                          .functor = "go_to",
                          .arguments = {._maximum = 1, ._length = 1, ._buffer = &position},
                          .writer_lost = saphira_v1_WRITER_LOST_CANCEL,
                          .withdrawn = ""};
  check(dds_write(goals, &goal), "goal");
  saphira_v1_GoalState last = (saphira_v1_GoalState)-1;
  bool taken_back = false;
  const dds_time_t began = dds_time();
  for (;;) {
    void* sample = NULL;
    while (take(statuses, &sample)) {
      const saphira_v1_GoalStatus* status = sample;
      if (status->id.writer != self) continue;
      if (status->state != last || ended(status->state))
        printf("%.1f s  %s, %.0f %%: %s%s\n", status->elapsed, kStates[status->state],
               100.0 * status->progress, status->step, status->reason);
      fflush(stdout);
      last = status->state;
      if (ended(status->state)) {
        const bool good = status->state == saphira_v1_GOAL_SUCCEEDED ||
                          (taken_back && status->state == saphira_v1_GOAL_CANCELED);
        dds_return_loan(statuses, &sample, 1);
        return good ? 0 : 1;
      }
    }
    const double seconds = (double)(dds_time() - began) * 1e-9;
    if (!taken_back && (stopped || (take_back > 0.0 && seconds > take_back))) {
      check(dds_dispose(goals, &goal), "dispose");
      taken_back = true;
    }
    dds_sleepfor(DDS_MSECS(50));
  }
}

/* Teleoperation: ten commands a second or more, for as long as a person wants to drive. The bridge
 * stops the robot 0.3 s after the last one, whatever becomes of this program; its guard holds. */
static int drive(double speed, double turn, double seconds) {
  const dds_entity_t commands = writer_of(&saphira_v1_MotorCommand_desc, "drive/teleop", MOTION);
  const dds_entity_t robots = reader_of(&saphira_v1_RobotState_desc, "robot/state", CYCLIC);
  const dds_entity_t grants = reader_of(&saphira_v1_Grant_desc, "drive/grant", CYCLIC);
  saphira_v1_MotorCommand command = {.source = "c_agent",
                                     .active = true,
                                     .translation = saphira_v1_TRANSLATION_VELOCITY,
                                     .velocity = speed,
                                     .rotation = saphira_v1_ROTATION_VELOCITY,
                                     .rotation_velocity = turn};
  bool seen = false;
  bool drives = false;
  int released = 0;
  dds_time_t began = dds_time();
  while (released < 4) {
    void* sample = NULL;
    while (take(robots, &sample)) {
      /* A driver must see the robot: a command names the robot state that it answers. */
      const saphira_v1_RobotState* robot = sample;
      command.stamp = robot->stamp;
      if (!seen) began = dds_time();
      seen = true;
    }
    while (take(grants, &sample)) {
      const saphira_v1_Grant* grant = sample;
      const bool now = strcmp(grant->source, "c_agent") == 0;
      if (now != drives)
        printf("%s: %s\n", now ? "c_agent drives" : "c_agent does not drive", grant->reason);
      fflush(stdout);
      drives = now;
    }
    const double passed = (double)(dds_time() - began) * 1e-9;
    if (!seen && passed > 10.0) {
      fprintf(stderr, "c_agent: nothing is heard of robot %s\n", robot_name());
      return 1;
    }
    if (seen) {
      if (stopped || passed > seconds) {
        /* Releases several times: the topic is best effort. Autonomy may drive again. */
        command.active = false;
        command.hand_back = true;
        ++released;
      }
      ++command.number;
      check(dds_write(commands, &command), "command");
    }
    dds_sleepfor(DDS_MSECS(50));
  }
  return 0;
}

int main(int argc, char** argv) {
  const char* domain = getenv("SAPHIRA_DOMAIN");
  const dds_domainid_t id = domain == NULL ? 0 : (dds_domainid_t)strtoul(domain, NULL, 10);
  signal(SIGINT, stop);
  signal(SIGTERM, stop);
  if (getenv("CYCLONEDDS_URI") == NULL) check(dds_create_domain(id, kThisMachine), "domain");
  participant = dds_create_participant(id, NULL, NULL);
  check(participant, "participant");
  dds_guid_t guid;
  check(dds_get_guid(participant, &guid), "guid");
  memcpy(&self, guid.v, sizeof self);

  int code = 2;
  if (argc == 2 && strcmp(argv[1], "state") == 0)
    code = state();
  else if (argc == 4 && strcmp(argv[1], "go") == 0)
    code = go(atof(argv[2]), atof(argv[3]), 0.0);
  else if (argc == 5 && strcmp(argv[1], "cancel") == 0)
    code = go(atof(argv[2]), atof(argv[3]), atof(argv[4]));
  else if (argc == 5 && strcmp(argv[1], "drive") == 0)
    code = drive(atof(argv[2]), atof(argv[3]), atof(argv[4]));
  else
    fprintf(stderr, "c_agent: expected state | go X Y | cancel X Y SECONDS | drive SPEED TURN SECONDS\n");
  dds_delete(DDS_CYCLONEDDS_HANDLE);
  return code;
}
