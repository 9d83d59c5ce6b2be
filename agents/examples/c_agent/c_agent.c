/* An agent in C on Cyclone DDS: looks at the robot, sends it to a point and follows that, takes the
 * goal back, drives it by hand; answers other agents, and asks them.
 *
 *   c_agent state              the robot's state for a second
 *   c_agent go X Y             to the point [m in odom]; exit code 0 when it is there
 *   c_agent cancel X Y SECONDS the same, and takes the goal back after so long
 *   c_agent drive SPEED TURN SECONDS   [m/s], [rad/s]; exit code 1 where it is stopped
 *   c_agent know PERSON PLACE  tells whoever asks where that person is, until Ctrl-C
 *   c_agent ask PERSON         asks all agents that can tell; exit code 0 when one knows
 *
 * SAPHIRA_ROBOT and SAPHIRA_DOMAIN say which robot. Without CYCLONEDDS_URI it speaks on this machine
 * alone, as the profile host does.
 *
 * Besides the types, a program on another vendor's DDS needs three things: the robot's name as its
 * partition, and the QoS of each topic (idl/README.md), both in reader_of and writer_of below; and
 * its presence, in rest(): without it others notice late that the program is gone.
 */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agents.h"
#include "dds/dds.h"
#include "intention.h"
#include "motion.h"
#include "request.h"
#include "robot.h"
#include "system.h"

/* With the lease of the other programs. A program that stood still for longer may not be found
 * again. */
static const char* const kThisMachine =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address='127.0.0.1' "
    "multicast='true'/></Interfaces></General><Discovery><LeaseDuration>60s</LeaseDuration>"
    "<SPDPInterval>1s</SPDPInterval><Ports><Base>7525</Base></Ports></Discovery></Domain>"
    "</CycloneDDS>";

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
enum qos { CYCLIC, MOTION, PRESENCE, COMMAND, GOAL, LATCHED, EVENT };

static dds_qos_t* qos_of(enum qos name, bool reader) {
  dds_qos_t* qos = dds_create_qos();
  const bool reliable = name != CYCLIC && name != MOTION && name != PRESENCE;
  const bool kept = reliable && name != COMMAND;
  const int most = name == EVENT ? 100 : name == COMMAND ? 16 : 1;
  const int reads = name == LATCHED ? 8 : most == 1 ? 4 : most;
  const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_reliability(qos, reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_SECS(1));
  dds_qset_durability(qos, kept ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, reader ? reads : most);
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

/* Waits, and says ten times a second that this program is there. */
static void rest(dds_duration_t time) {
  static dds_entity_t presence = 0;
  static dds_time_t said = 0;
  static saphira_v1_Presence sample;
  if (presence == 0) presence = writer_of(&saphira_v1_Presence_desc, "system/presence", PRESENCE);
  if (dds_time() - said >= DDS_MSECS(100)) {
    said = dds_time();
    sample.instance = self;
    ++sample.count;
    check(dds_write(presence, &sample), "presence");
  }
  dds_sleepfor(time);
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
    rest(DDS_MSECS(100));
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
    rest(DDS_MSECS(50));
  }
}

/* A secured bus puts the checked name of the program before its own. */
static bool is_own(const char* source) {
  const size_t length = strlen(source);
  return strcmp(source, "c_agent") == 0 ||
         (length > 9 && strcmp(source + length - 9, ", c_agent") == 0);
}

/* Teleoperation: ten commands a second or more, for as long as a person wants to drive. The bridge
 * stops the robot 0.3 s after the last one, whatever becomes of this program; its guard holds. A
 * driver who was stopped, or does not get the robot within a second, gives up: exit code 1. */
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
  bool drove = false;
  bool fails = false;
  char why[256] = "the bridge says nothing";
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
      drives = is_own(grant->source);
      if (drives && !drove) printf("c_agent drives: %s\n", grant->reason);
      fflush(stdout);
      drove = drove || drives;
      snprintf(why, sizeof why, "%s", grant->reason);
      for (uint32_t i = 0; i < grant->refused._length; ++i)
        if (is_own(grant->refused._buffer[i].source))
          snprintf(why, sizeof why, "%s", grant->refused._buffer[i].reason);
      if (grant->estopped)
        snprintf(why, sizeof why, "an emergency stop is latched, pressed by %s: saphira estop reset",
                 grant->estop_source);
    }
    const double passed = (double)(dds_time() - began) * 1e-9;
    if (!seen && passed > 10.0) {
      fprintf(stderr, "c_agent: nothing is heard of robot %s\n", robot_name());
      return 1;
    }
    if (seen && released == 0 && !drives && (drove || passed > 1.0)) {
      fprintf(stderr, "c_agent: %s: %s\n", drove ? "it drives no more" : "it may not drive", why);
      fails = true;
    }
    if (seen) {
      if (stopped || fails || passed > seconds) {
        /* Releases several times: the topic is best effort. Autonomy may drive again. */
        command.active = false;
        command.hand_back = true;
        ++released;
      }
      ++command.number;
      check(dds_write(commands, &command), "command");
    }
    rest(DDS_MSECS(50));
  }
  if (!fails && !drove) fprintf(stderr, "c_agent: it did not drive: %s\n", why);
  return drove && !fails ? 0 : 1;
}

/* The text of an argument; "" where it has none of that name. */
static const char* text_of(const saphira_v1_Request* request, const char* name) {
  for (uint32_t i = 0; i < request->arguments._length; ++i) {
    const saphira_v1_Argument* one = &request->arguments._buffer[i];
    if (strcmp(one->name, name) == 0 && one->kind == saphira_v1_ARGUMENT_TEXT) return one->text;
  }
  return "";
}

static saphira_v1_Argument text_argument(const char* name, const char* text) {
  return (saphira_v1_Argument){
      .name = (char*)name, .kind = saphira_v1_ARGUMENT_TEXT, .text = (char*)text};
}

/* Announces that it can tell the places of people, and answers. The facilitator routes the requests
 * of all askers here, by the address ID/NAME. The announcement ends with this program. */
static int know(const char* person, const char* place) {
  const dds_entity_t requests = reader_of(&saphira_v1_Request_desc, "agents/request", COMMAND);
  const dds_entity_t answers = writer_of(&saphira_v1_Answer_desc, "agents/answers", EVENT);
  const dds_entity_t agents = writer_of(&saphira_v1_Agent_desc, "agents", LATCHED);
  saphira_v1_CapabilityParameter parameters[2] = {
      {.name = "person", .kind = saphira_v1_ARGUMENT_TEXT, .meaning = "a name", .required = true},
      {.name = "place", .kind = saphira_v1_ARGUMENT_TEXT, .meaning = "of the map"}};
  saphira_v1_Capability capability = {
      .functor = "place_of",
      .summary = "where a person is",
      .parameters = {._maximum = 2, ._length = 2, ._buffer = parameters}};
  saphira_v1_Agent agent = {.id = self,
                            .name = "c_agent",
                            .summary = "knows where a person is",
                            .capabilities = {._maximum = 1, ._length = 1, ._buffer = &capability}};
  check(dds_write(agents, &agent), "agent");
  char address[64];
  snprintf(address, sizeof address, "%llx/c_agent", (unsigned long long)self);
  while (!stopped) {
    void* sample = NULL;
    while (take(requests, &sample)) {
      const saphira_v1_Request* request = sample;
      if (strcmp(request->service, address) != 0) continue;
      const bool known = strcmp(text_of(request, "person"), person) == 0;
      saphira_v1_Argument result = text_argument("place", place);
      const saphira_v1_Answer answer = {
          .stamp = request->stamp,
          .asker = request->asker,
          .number = request->number,
          .service = address,
          .code = known ? saphira_v1_ANSWER_DONE : saphira_v1_ANSWER_REFUSED,
          .text = known ? "" : "this agent knows one person alone",
          .results = {._maximum = 1, ._length = known ? 1 : 0, ._buffer = &result}};
      check(dds_write(answers, &answer), "answer");
      printf("%s asked for %s\n", request->source, text_of(request, "person"));
      fflush(stdout);
    }
    rest(DDS_MSECS(20));
  }
  check(dds_dispose(agents, &agent), "agent");
  return 0;
}

static int ask(const char* person) {
  const dds_entity_t answers = reader_of(&saphira_v1_Answer_desc, "agents/solved", EVENT);
  const dds_entity_t requests = writer_of(&saphira_v1_Request_desc, "agents/solve", COMMAND);
  saphira_v1_Argument arguments[2] = {
      text_argument("person", person),
      {.name = "place", .kind = saphira_v1_ARGUMENT_UNBOUND, .text = ""}};
  const saphira_v1_Request request = {.asker = self,
                                      .number = 1,
                                      .source = "c_agent",
                                      .service = "",
                                      .functor = "place_of",
                                      .arguments = {._maximum = 2, ._length = 2, ._buffer = arguments},
                                      .deadline = 5.0};
  bool sent = false;
  for (const dds_time_t began = dds_time(); !stopped && dds_time() - began < DDS_SECS(15);) {
    /* A command is not kept for late readers: the facilitator has to be there first. */
    dds_publication_matched_status_t matched;
    if (!sent && dds_get_publication_matched_status(requests, &matched) == 0 &&
        matched.current_count > 0) {
      check(dds_write(requests, &request), "request");
      sent = true;
    }
    void* sample = NULL;
    while (take(answers, &sample)) {
      const saphira_v1_Answer* answer = sample;
      if (answer->asker != self || answer->code == saphira_v1_ANSWER_UNDERWAY) continue;
      const bool good = answer->code == saphira_v1_ANSWER_DONE && answer->results._length > 0;
      if (good)
        printf("%s is in %s, by %s\n", person, answer->results._buffer[0].text, answer->service);
      else
        fprintf(stderr, "c_agent: %s\n", answer->text);
      dds_return_loan(answers, &sample, 1);
      return good ? 0 : 1;
    }
    rest(DDS_MSECS(20));
  }
  fprintf(stderr, "c_agent: %s\n", sent ? "no answer" : "no facilitator is on the bus");
  return 1;
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
  else if (argc == 4 && strcmp(argv[1], "know") == 0)
    code = know(argv[2], argv[3]);
  else if (argc == 3 && strcmp(argv[1], "ask") == 0)
    code = ask(argv[2]);
  else
    fprintf(stderr, "c_agent: expected state | go X Y | cancel X Y SECONDS | drive SPEED TURN SECONDS"
                    " | know PERSON PLACE | ask PERSON\n");
  dds_delete(DDS_CYCLONEDDS_HANDLE);
  return code;
}
