#include <functional>

#include "office.hpp"
#include "table.hpp"

namespace saphira::situation::test {
namespace {

using Change = std::function<void(Situation&)>;

Case when(const std::string& words, const std::string& question, const Situation& before,
          const std::vector<Change>& changes, std::vector<std::string> must,
          std::vector<std::string> must_not = {}) {
  Case one{words, question, before, std::move(must), std::move(must_not)};
  for (const Change& change : changes)
    change(one.situation);
  return one;
}

/// Its samples ended `cycles` ago; its newest is not the expected one.
Change silent(const std::string& name, std::uint64_t cycles) {
  return [=](Situation& s) {
    if (name == "behaviors") {
      s.behaviors.reset();
      s.behaviors_known.newest = s.now - cycles;
    } else {
      s.intentions.reset();
      s.intentions_known.newest = s.now - cycles;
    }
  };
}
Change lost(const std::string& name, double seconds) {
  return [=](Situation& s) { find(s, name).age = seconds; };
}
Change absent(const std::string& name) {
  return [=](Situation& s) { remove(s, name); };
}
Change stands(const std::string& reason) {
  return [=](Situation& s) { stand(s, reason); };
}
void no_intent(Situation& s) {
  s.behaviors->limit_reason = "no newer intent has come for 3 cycles";
}

void intentions_gone(std::vector<Case>& all) {
  // Its goal's status is latched, and still there.
  const Situation before = driving();
  const std::vector<std::string> never{"nobody has asked", "no goal is underway"};
  all.push_back(when("intentions hangs for 2 s, a goal was underway", "why", before,
                     {stands("nothing asks the robot to move"), silent("intentions", 20)},
                     {"The robot stands", "intentions has said nothing for 2.0 s"}, never));
  all.push_back(when("the same", "trouble", before, {silent("intentions", 20)},
                     {"intentions has said nothing for 2.0 s"}, {"behaviors"}));
  all.push_back(
      when("intentions was killed 5 s ago", "why", before,
           {stands("nothing asks the robot to move"), silent("intentions", 50),
            lost("intentions", 5.2), [](Situation& s) { s.statuses[0].stamp.cycle = s.now - 58; }},
           {"intentions has not been heard for 5.2 s",
            "last known of go_to(position=(3, 1) in odom) of saphira goal: underway, 5.8 s ago"},
           never));
  all.push_back(when("the same, of a goal of before the robot's restart", "why", before,
                     {stands("nothing asks the robot to move"), silent("intentions", 50),
                      lost("intentions", 5.2), [](Situation& s) { s.statuses[0].stamp.epoch = 6; }},
                     {"intentions has not been heard for 5.2 s"}, {"underway", "ago"}));
  all.push_back(
      when("intentions is on the far side of a cut link, and behaviors says so", "why", before,
           {stands("nothing asks the robot to move"), no_intent, silent("intentions", 40),
            lost("intentions", 4.0)},
           {"no newer intent has come", "intentions has not been heard for 4.0 s"}, never));
  all.push_back(when(
      "intentions is not heard", "why", before,
      {stands("nothing asks the robot to move"), silent("intentions", 100), absent("intentions")},
      {"intentions is not heard"}, never));
  all.push_back(when("the same, for who came after it died", "why", before,
                     {stands("nothing asks the robot to move"), absent("intentions"),
                      [](Situation& s) {
                        s.intentions.reset();
                        s.intentions_known = {};
                        s.statuses.clear();
                        s.goals.clear();
                        s.statuses_known = false;
                      }},
                     {"intentions is not heard"}, never));
  all.push_back(when("intentions was started again, and does not know the goal yet", "why", before,
                     {stands("nothing asks the robot to move"),
                      [](Situation& s) {
                        s.intentions->behaviors.clear();
                        s.intentions->nodes.clear();
                        find(s, "intentions").status.uptime = 0.8;
                      }},
                     {"go_to(position=(3, 1) in odom) of saphira goal is underway"}, never));
  all.push_back(when("the same", "why tree", before,
                     {stands("nothing asks the robot to move"),
                      [](Situation& s) {
                        s.intentions->behaviors.clear();
                        find(s, "intentions").status.uptime = 0.8;
                      }},
                     {"intentions was started 0.8 s ago"}));
  all.push_back(when(
      "behaviors drives on an intent that is 0.4 s old", "why", before, {silent("intentions", 4)},
      {"drive ahead", "the goal behind it is not known: intentions is 0.4 s behind"}, {"stands"}));
  all.push_back(when("intentions waits for the robot", "trouble", before, {[](Situation& s) {
                       Program& program = find(s, "intentions");
                       program.status.state = v1::SERVICE_WAITING;
                       program.status.reason = "waits for robot/state";
                     }},
                     {"intentions is waiting: waits for robot/state"}));
}

void behaviors_gone(std::vector<Case>& all) {
  const Situation before = driving();
  const std::string lease =
      "the lease of behaviors (behaviors) ran out: its newest command is 2.0 s old";
  all.push_back(
      when("behaviors is frozen for 2 s", "why", before, {stands(lease), silent("behaviors", 20)},
           {"behaviors has said nothing for 2.0 s"}, {"does not want", "nobody has asked"}));
  all.push_back(when("the same", "why not turn left", before,
                     {stands(lease), silent("behaviors", 20)},
                     {"behaviors has said nothing for 2.0 s"}, {"It does turn"}));
  all.push_back(when("behaviors is frozen for 10 s", "why", before,
                     {stands("the lease of behaviors (behaviors) ran out"),
                      silent("behaviors", 100), lost("behaviors", 10.0)},
                     {"behaviors has not been heard for 10 s"}, {"does not want"}));
  all.push_back(when(
      "behaviors is not heard", "why", before,
      {stands("nothing asks the robot to move"), silent("behaviors", 100), absent("behaviors")},
      {"behaviors is not heard"}, {"nobody has asked", "no goal"}));
  all.push_back(when("the same", "trouble", before, {silent("behaviors", 100), absent("behaviors")},
                     {"behaviors is not heard"}));
  all.push_back(when("just started again: the command is of the process before", "why", before,
                     {[](Situation& s) {
                       s.behaviors.reset();
                       s.behaviors_known = {s.now, s.now};
                       s.grant->velocity = 0.05;
                       s.robot->velocity = 0.05;
                       find(s, "behaviors").status.uptime = 0.2;
                     }},
                     {"its reasons are not known", "behaviors was started 0.2 s ago"},
                     {"no behavior wants a speed"}));
  all.push_back(when("the network is slow, so it drives slower", "why", before, {[](Situation& s) {
                       s.behaviors->limit_reason = "intentions are 0.5 s old";
                       s.behaviors->speed_limit = 0.2;
                       s.grant->velocity = 0.2;
                       s.robot->velocity = 0.2;
                     }},
                     {"0.20 m/s", "intentions are 0.5 s old, so it drives no faster than 0.20"}));
}

void bridge_gone(std::vector<Case>& all) {
  const Situation before = driving();
  const Change quiet = [](Situation& s) { s.silence = 4.0; };
  all.push_back(when("the bridge was killed 4 s ago", "why", before, {quiet, lost("bridge", 4.3)},
                     {"The robot's motion is not known", "nothing has been heard of it for 4.0 s",
                      "bridge has not been heard for 4.3 s"},
                     {"stands"}));
  all.push_back(when("the same", "drive", before, {quiet, lost("bridge", 4.3)},
                     {"not known any more", "bridge has not been heard"}, {"behaviors drives"}));
  all.push_back(when("the same", "why not faster", before, {quiet, lost("bridge", 4.3)},
                     {"The robot's motion is not known"}));
  all.push_back(when("the bridge lost its robot", "why", before,
                     {quiet,
                      [](Situation& s) {
                        Program& program = find(s, "bridge");
                        program.status.state = v1::SERVICE_WAITING;
                        program.status.reason = "no answer from tcp:192.0.2.7:8101";
                      }},
                     {"The robot's motion is not known", "bridge is waiting: no answer from"}));
  all.push_back(when("no robot is connected yet", "why", resting(), {[](Situation& s) {
                       s.grant->stamp.epoch = 0;
                       s.grant->reason = "no robot is connected";
                     }},
                     {"no robot is connected"}));
  Situation nothing;
  nothing.listened = 3.0;
  all.push_back(when("nothing is on the bus", "why", nothing, {},
                     {"Nothing is known", "bridge, behaviors and intentions are not heard"},
                     {"stands", "nobody has asked"}));
  all.push_back(
      when("the same", "trouble", nothing, {}, {"bridge, behaviors and intentions are not heard"}));
  all.push_back(
      when("the same", "drive", nothing, {}, {"not known", "bridge is not heard"}, {"nobody"}));
  const Change searching = [](Situation& s) {
    for (const char* const name : {"bridge", "behaviors", "intentions"}) {
      Program one = program(name);
      one.status.state = v1::SERVICE_WAITING;
      one.status.reason = "waits for robot/state of cycle 162";
      s.programs.push_back(one);
    }
    find(s, "bridge").status.reason =
        "waits for the robot to answer SYNC0 (is it switched on, and the cable in?)";
  };
  const std::string sync0 =
      "bridge is waiting: waits for the robot to answer SYNC0 (is it switched on, and the cable "
      "in?)";
  all.push_back(when("the robot has been silent since before we came: the bridge looks for it",
                     "why", nothing, {searching}, {"Nothing is known", sync0}, {"stands"}));
  all.push_back(
      when("the robot fell silent 6 s ago, and the bridge looks for it anew", "why", nothing,
           {searching,
            [](Situation& s) {
              s.now = 161;
              s.silence = 6.0;
            }},
           {"The robot's motion is not known", "nothing has been heard of it for 6.0 s", sync0},
           {"stands", "Nothing is known"}));
  all.push_back(when("we have listened for a moment only", "trouble", Situation{},
                     {[](Situation& s) { s.listened = 0.1; }}, {}, {"is not heard"}));
}

void past(std::vector<Case>& all) {
  const Change then = [](Situation& s) {
    s.past = true;
    s.cycle = 900;
  };
  Situation before = resting();
  then(before);
  all.push_back(when("a standstill of before: what is suspended and missing now is not why", "why",
                     before,
                     {[](Situation& s) {
                        s.statuses = {goal_status(v1::GOAL_FAILED, "the way is blocked")};
                        s.goals = driving().goals;
                        suspend(s, 950);
                      },
                      absent("behaviors")},
                     {"failed, the way is blocked"}, {"suspended", "is not heard"}));
  all.push_back(when("a standstill of before, without a goal", "why", before, {},
                     {"no goal was underway"}, {"nobody has asked"}));
  all.push_back(when("intentions was killed before that cycle", "why", before, {[](Situation& s) {
                       s.intentions.reset();
                       s.intentions_known = {500, 880};
                       s.statuses_known = false;
                     }},
                     {"intentions has said nothing since cycle 880"},
                     {"no goal", "nobody has asked"}));
  all.push_back(when("intentions was started again after that cycle", "why", before,
                     {[](Situation& s) {
                       s.intentions.reset();
                       s.intentions_known = {950, 1000};
                       s.statuses_known = false;
                     }},
                     {"intentions has kept nothing from before cycle 950"}, {"no goal"}));
  all.push_back(when("behaviors has left nothing of that time", "why", before, {[](Situation& s) {
                       s.behaviors.reset();
                       s.behaviors_known = {};
                     }},
                     {"behaviors has left nothing of the last minute"}, {"is not heard"}));
  Situation drove = driving();
  then(drove);
  all.push_back(when("a drive of before, of which behaviors left the cycle out", "why", drove,
                     {[](Situation& s) {
                       s.behaviors.reset();
                       s.behaviors_known = {500, 1000};
                     }},
                     {"behaviors left this cycle out"}, {"stand"}));
  all.push_back(when("a drive of before; now nothing is heard of the robot", "why", drove,
                     {[](Situation& s) { s.silence = 20.0; }, absent("bridge")},
                     {"drive ahead at 0.30 m/s", "GoToPos"}, {"not known", "not on the bus"}));
}

/// The line to the robot damages packets.
void bad_line(std::vector<Case>& all) {
  const std::string words = "the line to the robot is bad: 17 of its last 50 packets were damaged";
  const Change says = [=](Situation& s) {
    find(s, "bridge").status.state = v1::SERVICE_DEGRADED;
    find(s, "bridge").status.reason = words;
  };
  all.push_back(when("a third of the robot's packets are damaged", "why tree", driving(), {says},
                     {"bridge is degraded: " + words}));
  all.push_back(
      when("the robot is not heard while it moves", "why", driving(),
           {stands("nothing asks the robot to move"),
            [](Situation& s) {
              s.grant->refused.push_back(
                  {.role = v1::ROLE_BEHAVIORS,
                   .source = "behaviors",
                   .reason = "the robot is not heard while it moves (3 times now): it stands for "
                             "another 20 s"});
            }},
           {"The robot stands", "behaviors (behaviors) was refused", "is not heard while it moves"},
           {"nobody asks"}));
}

/// The wheels do not obey.
void wheels(std::vector<Case>& all) {
  const std::string off = "its motors are off (saphira device motors on)";
  const Change no_power = [](Situation& s) {
    s.robot->status = v1::MOTORS_NO_POWER;
    s.robot->velocity = 0.0;
    find(s, "bridge").status.state = v1::SERVICE_DEGRADED;
    find(s, "bridge").status.reason =
        "the robot's motors are off (its own button, or: saphira device motors on)";
  };
  const Change by_hand = [](Situation& s) {
    by_keyboard(s, 0.2, 0.0);
    s.robot->velocity = 0.0;
  };
  const Change failed = [](Situation& s) {
    s.goals = driving().goals;
    s.statuses = {goal_status(v1::GOAL_FAILED,
                              "no nearer for 20 s, 3.00 m from the point; it has not moved at all: "
                              "are its motors on? (saphira device motors on)")};
  };
  all.push_back(when("the motors are off", "why", driving(), {no_power},
                     {"drive ahead at 0.30 m/s", off}, {"blocked", "stalled"}));
  all.push_back(when("the same", "why tree", driving(), {no_power},
                     {"|- " + off, "bridge is degraded: the robot's motors are off"}));
  all.push_back(when("the same", "why not faster", driving(), {no_power},
                     {"It does not go faster", off}, {"It does go"}));
  all.push_back(when("the same", "why not turn left", driving(), {no_power},
                     {"It does not turn left", off}, {"It does turn"}));
  all.push_back(when("the same, and a person drives", "why", driving(), {by_hand, no_power},
                     {"keyboard of ann drives it", off}));
  all.push_back(when("the same, and behaviors is not heard", "why", driving(),
                     {no_power, silent("behaviors", 20)}, {"drive ahead at 0.30 m/s", off}));
  all.push_back(when("the motors are off, and nothing is asked for", "why", resting(), {no_power},
                     {"no goal is underway"}, {off}));
  all.push_back(when("the motors were switched off as it drove: it still rolls", "why", driving(),
                     {no_power, [](Situation& s) { s.robot->velocity = 0.2; }},
                     {"now it drives at 0.20 m/s"}, {off}));
  all.push_back(when("a goal failed, of a robot that does not report its motors", "why", resting(),
                     {failed},
                     {"failed, no nearer",
                      "it has not moved at all: are its motors on? (saphira device motors "
                      "on)"}));
  all.push_back(when("its left wheel is stalled", "why", driving(),
                     {[](Situation& s) { s.robot->left_stalled = true; }},
                     {"its left wheel is stalled"}, {"right wheel", "motors are off"}));
  all.push_back(when("both wheels are stalled at a wall", "why", driving(), {[](Situation& s) {
                       s.robot->left_stalled = true;
                       s.robot->right_stalled = true;
                       s.robot->velocity = 0.0;
                     }},
                     {"both wheels are stalled"}, {"motors are off"}));
}

void lost_on_the_map(std::vector<Case>& all) {
  const std::string words = "the robot does not know where it is on the map";
  const Change nowhere = [](Situation& s) {
    v1::Registration place{.stamp = s.robot->stamp,
                           .state = v1::REGISTRATION_LOST,
                           .reason = "nothing that it hears fits the map"};
    s.registration = place;
  };
  const Change tracking = [](Situation& s) {
    s.registration.emplace();
    s.registration->state = v1::REGISTRATION_TRACKING;
    s.registration->confidence = 0.97;
  };
  const Change straight_on = [](Situation& s) {
    auto& behaviors = s.behaviors->behaviors;
    behaviors.erase(behaviors.begin());
    behaviors[0].recommends_turn = false;
    s.behaviors->turning = false;
  };
  all.push_back(when("the robot is lost on the map, at rest", "why", resting(), {nowhere},
                     {"The robot stands: no goal is underway; " + words}));
  all.push_back(when("the same", "why tree", resting(), {nowhere},
                     {words + ", 0 % sure (nothing that it hears fits the map): saphira map place "
                              "X Y TH"}));
  all.push_back(when("the robot is lost on the map, a goal in odom drives", "why", driving(),
                     {nowhere, straight_on},
                     {"drive ahead at 0.30 m/s", "GoToPos wants 0.30 m/s", words}));
  all.push_back(when("the same, past an obstacle", "why", driving(), {nowhere},
                     {"drive ahead at 0.30 m/s", "11 degrees to the left", "lost on the map"}));
  all.push_back(when("the robot is lost on the map, and a person drives", "why", driving(),
                     {nowhere, [](Situation& s) { by_keyboard(s, 0.2, 0.0); }},
                     {"keyboard of ann", words}));
  all.push_back(when("the robot is lost on the map, and a goal about a place waits", "why",
                     resting(),
                     {nowhere,
                      [](Situation& s) {
                        s.goals = driving().goals;
                        s.statuses = {goal_status(v1::GOAL_UNDERWAY)};
                        s.statuses[0].step = "waits to know where it is on the map";
                      }},
                     {"waits to know where it is on the map"}));
  all.push_back(when("the robot is lost on the map now; a standstill of before", "why", resting(),
                     {nowhere,
                      [](Situation& s) {
                        s.past = true;
                        s.cycle = 900;
                      }},
                     {"no goal was underway"}, {"map"}));
  const Change hardly = [&](Situation& s) {
    tracking(s);
    s.registration->stamp = s.robot->stamp;
    s.registration->confidence = 0.3;
    s.registration->reason = "the readings hardly fit the map";
    s.doubtful_since = s.now - 120;
  };
  const std::string doubt =
      "the robot is 30 % sure of its place on the map, in doubt for 12 s: the readings hardly fit "
      "the map";
  all.push_back(when("the robot was carried elsewhere, and is not lost yet", "why", resting(),
                     {hardly}, {"no goal is underway; " + doubt}, {"does not know where it is"}));
  all.push_back(when("the same, past an obstacle", "why", driving(), {hardly},
                     {"drive ahead at 0.30 m/s", "of its place on the map"}));
  all.push_back(when("the same, for who came after that", "why tree", resting(),
                     {hardly, [](Situation& s) { s.doubtful_since = 0; }},
                     {"30 % sure of its place on the map: the readings"}, {"in doubt for"}));
  all.push_back(when("the robot knows its place", "why tree", driving(), {tracking}, {},
                     {"on the map", "map place"}));
}

}  // namespace

std::vector<Case> bad_cases() {
  std::vector<Case> all;
  intentions_gone(all);
  behaviors_gone(all);
  bridge_gone(all);
  bad_line(all);
  wheels(all);
  lost_on_the_map(all);
  past(all);
  return all;
}

}  // namespace saphira::situation::test
