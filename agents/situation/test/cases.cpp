#include <functional>

#include "office.hpp"
#include "saphira/geometry/pose.hpp"
#include "table.hpp"

namespace saphira::situation::test {
namespace {

using Change = std::function<void(Situation&)>;

Case while_driving(const std::string& words, const std::string& question, const Change& change,
                   std::vector<std::string> must, std::vector<std::string> must_not = {}) {
  Case one{words, question, driving(), std::move(must), std::move(must_not)};
  change(one.situation);
  return one;
}

Case at_rest(const std::string& words, const std::string& question, const Change& change,
             std::vector<std::string> must, std::vector<std::string> must_not = {}) {
  Case one{words, question, resting(), std::move(must), std::move(must_not)};
  change(one.situation);
  return one;
}

void all_is_well(std::vector<Case>& all) {
  const auto well = [](Situation&) {};
  const std::string goal = "for go_to(position=(3, 1) in odom) of saphira goal";
  all.push_back(while_driving("a goal drives past an obstacle", "why", well,
                              {"drive ahead at 0.30 m/s", "11 degrees to the left",
                               "GoToPos wants 0.30 m/s", "KeepOff", "go_to", "saphira goal"},
                              {"stands", "nobody"}));
  all.push_back(while_driving("the same", "why tree", well,
                              {"rule Obstacle-Right holds to 1.00", "front_right 1.00",
                               "for go_to: driving to (3.00, 1.00)", "of saphira goal"}));
  all.push_back(while_driving("the same", "trouble", well, {}, {"behaviors", "intentions"}));
  all.push_back(while_driving("the same", "drive", well, {"behaviors drives"}));
  all.push_back(while_driving(
      "it steers left, though the goal lies to the right", "why not turn right", well,
      {"GoToPos would (rule Right", "KeepOff wants 20 degrees to the left"}, {"It does turn"}));
  all.push_back(
      while_driving("the same", "why not turn left", well, {"It does turn left"}, {"does not"}));
  all.push_back(while_driving("as fast as is wanted", "why not faster", well,
                              {"no running behavior wants that", "GoToPos wants 0.30 m/s"}));
  all.push_back(while_driving("it has just begun to drive", "why not faster",
                              [](Situation& s) { s.robot->velocity = 0.1; },
                              {"It does go faster", "now it drives at 0.10 m/s"}));
  all.push_back(while_driving("only one behavior, straight on", "why",
                              [](Situation& s) {
                                auto& behaviors = s.behaviors->behaviors;
                                behaviors.erase(behaviors.begin());
                                behaviors[0].recommends_turn = false;
                                s.behaviors->turning = false;
                              },
                              {"straight on", "GoToPos wants 0.30 m/s (rule Fast)", goal},
                              {"KeepOff", "left"}));
  const auto blocked = [](Situation& s) {
    guard(s, v1::GUARD_STOP, "something 0.12 m ahead", 0.0);
  };
  all.push_back(while_driving(
      "the guard stops it before a wall", "why", blocked,
      {"turn on the spot", "the guard beside the robot stops it (something 0.12 m ahead)"},
      {"drive ahead"}));
  all.push_back(while_driving(
      "the same", "why not faster", blocked,
      {"because the guard beside the robot stops it", "the behaviors want 0.30 m/s"}));
  const std::string echo =
      "something 0.12 m ahead; it lets go beyond 0.25 m; sonar 3 heard it 4.0 s ago";
  const auto by_memory = [=](Situation& s) { guard(s, v1::GUARD_STOP, echo, 0.0); };
  all.push_back(while_driving("the guard stops it, by an echo that is old", "why", by_memory,
                              {"the guard beside the robot stops it (something 0.12 m ahead"}));
  all.push_back(while_driving("the same", "why tree", by_memory,
                              {"the guard beside the robot stops it (" + echo + ")"}));
  all.push_back(while_driving("the same, and a person drives", "why",
                              [=](Situation& s) {
                                by_keyboard(s, 0.0, 0.0);
                                by_memory(s);
                              },
                              {"keyboard of ann", "stops it (" + echo + ")"}));
  all.push_back(while_driving("the guard slows it", "why",
                              [](Situation& s) { guard(s, v1::GUARD_SLOW, "0.6 m ahead", 0.1); },
                              {"0.10 m/s", "slows it (0.6 m ahead)"}));
  all.push_back(while_driving("an activity monitors what may go wrong", "why tree",
                              [](Situation& s) {
                                v1::IntentionNode& node = s.intentions->nodes[0];
                                node.schema = "follow-path";
                                node.label = "TROUBLE";
                                node.step = "waits until the leg is done";
                              },
                              {"for follow-path: waits until the leg is done"}, {"TROUBLE"}));
  all.push_back(while_driving("a long name of a place and of who asked", "why",
                              [](Situation& s) {
                                s.goals[0].functor = "go-to-place";
                                s.goals[0].arguments[0].kind = v1::ARGUMENT_TEXT;
                                s.goals[0].arguments[0].text = std::string(200, 'x');
                                s.goals[0].requester = "the calendar of the third floor";
                              },
                              {"drive ahead at 0.30 m/s", "go-to-place of the calendar"},
                              {"xxxx"}));
  all.push_back(while_driving("no behavior wants a speed any more, the rest of one is left", "why",
                              [](Situation& s) {
                                s.behaviors->behaviors.clear();
                                s.behaviors->turning = false;
                                s.behaviors->moving = false;
                                s.grant->velocity = 0.06;
                                s.robot->velocity = 0.06;
                              },
                              {"0.06 m/s", "it slows down, no behavior wants a speed any more"}));
  all.push_back(while_driving("a person who joined late does not know the goal", "why",
                              [](Situation& s) {
                                s.goals.clear();
                                s.statuses.clear();
                                s.statuses_known = false;
                              },
                              {"a goal of which nothing is known"}, {"nobody has asked"}));
}

void goals(std::vector<Case>& all) {
  all.push_back(at_rest("nothing was ever asked for", "why", [](Situation&) {},
                        {"The robot stands", "no goal is underway"},
                        {"is not heard", "drives it"}));
  all.push_back(at_rest("the same", "why not faster", [](Situation&) {},
                        {"It does not go faster", "no goal is underway"}, {"It does go"}));
  const std::vector<std::tuple<std::string, v1::GoalState, std::string>> ends{
      {"arrived", v1::GOAL_SUCCEEDED, "succeeded, the reason"},
      {"gave up", v1::GOAL_FAILED, "failed, the reason"},
      {"was refused", v1::GOAL_REFUSED, "refused, the reason"},
      {"was canceled", v1::GOAL_CANCELED, "canceled, the reason"},
      {"waits its turn", v1::GOAL_WAITING, "waiting, the reason"},
      {"is suspended by a more important one", v1::GOAL_SUSPENDED, "suspended, the reason"}};
  for (const auto& [words, state, said] : ends)
    all.push_back(at_rest("the newest goal " + words, "why",
                          [state = state](Situation& s) {
                            s.goals = driving().goals;
                            s.statuses = {goal_status(state, "the reason")};
                          },
                          {"The robot stands", "no goal is underway", said}, {"nobody has asked"}));
  all.push_back(at_rest("a person has stopped it", "why",
                        [](Situation& s) {
                          s.statuses = {goal_status(v1::GOAL_SUCCEEDED, "it stands")};
                          s.statuses[0].functor = "stop";
                          s.statuses[0].requester = "somebody at the console";
                        },
                        {"somebody at the console stopped it, and no goal is underway"},
                        {"stop()", "succeeded"}));
  all.push_back(at_rest("a goal is underway, and waits for a door", "why",
                        [](Situation& s) {
                          s.goals = driving().goals;
                          s.statuses = {goal_status(v1::GOAL_UNDERWAY)};
                          s.statuses[0].step = "waits for the door to open";
                        },
                        {"is underway and intends no behavior now: waits for the door to open"},
                        {"nobody has asked", "no goal"}));
  const auto rolling = [](Situation& s) {
    stand(s);
    s.robot->velocity = 0.4;
    s.intentions->behaviors.clear();
    s.statuses = {goal_status(v1::GOAL_CANCELED, "withdrawn by saphira goal")};
  };
  all.push_back(while_driving("just canceled: the robot still rolls", "why", rolling,
                              {"told to stop", "now it drives at 0.40 m/s", "canceled"},
                              {"stands"}));
  all.push_back(
      while_driving("the same", "why not slower", rolling, {"It does go slower"}, {"stands"}));
  all.push_back(at_rest("just stopped: it still turns", "why",
                        [](Situation& s) { s.robot->rotation_velocity = radians(20.0); },
                        {"told to stop", "turns at 20 degrees/s to the left"}, {"stands"}));
  all.push_back(at_rest("a micro-task is suspended", "why", [](Situation& s) { suspend(s, 900); },
                        {"execute-intentions of intentions is suspended"}, {"nobody has asked"}));
  all.push_back(at_rest("behavior control is switched off", "why",
                        [](Situation& s) { s.intentions->behavior_control = false; },
                        {"behavior control is switched off"}, {"nobody has asked"}));
}

void people(std::vector<Case>& all) {
  const auto turning = [](Situation& s) { by_keyboard(s, 0.0, 0.785); };
  all.push_back(while_driving("a person turns it by keyboard", "why", turning,
                              {"turn on the spot, at 45 degrees/s to the left", "keyboard of ann"},
                              {"0.00 m/s", "stands", "behaviors"}));
  all.push_back(while_driving("the same", "why not turn left", turning,
                              {"It does turn left", "keyboard of ann"}, {"does not turn"}));
  all.push_back(while_driving("the same", "why not turn right", turning,
                              {"It does not turn right", "keyboard of ann"}, {"It does turn"}));
  all.push_back(while_driving(
      "a person drives it in a curve", "why", [](Situation& s) { by_keyboard(s, 0.2, -0.3); },
      {"drive ahead at 0.20 m/s and to turn at 17 degrees/s to the right", "keyboard of ann"}));
  all.push_back(
      while_driving("a person backs it up", "why", [](Situation& s) { by_keyboard(s, -0.1, 0.0); },
                    {"back up at 0.10 m/s", "keyboard of ann drives it (teleop)"}, {"ahead"}));
  all.push_back(while_driving("a person gives it a heading", "why",
                              [](Situation& s) {
                                by_keyboard(s, 0.0, 0.0);
                                s.grant->rotation = v1::ROTATION_HEADING;
                                s.grant->heading = radians(90.0);
                                s.robot->pose_in_odom.th = radians(60.0);
                              },
                              {"turn on the spot, 30 degrees to the left"}));
  all.push_back(while_driving("a person holds it still", "why",
                              [](Situation& s) { by_keyboard(s, 0.0, 0.0); },
                              {"told to stand", "keyboard of ann drives it"}));
  all.push_back(while_driving("the guard slows a person", "why",
                              [](Situation& s) {
                                by_keyboard(s, 0.1, 0.0);
                                guard(s, v1::GUARD_SLOW, "0.6 m ahead", 0.1);
                              },
                              {"keyboard of ann", "slows it (0.6 m ahead)"}));
  const auto drove = [](Situation& s) { s.grant->waits_for_hand_back = true; };
  all.push_back(
      at_rest("a person drove minutes ago and has not handed back", "why", drove,
              {"autonomy waits until the robot is handed back", "saphira drive hand-back"},
              {"does not want", "keyboard"}));
  all.push_back(at_rest("the same", "drive", drove, {"saphira drive hand-back"},
                        {"does not want", "keyboard"}));
  all.push_back(at_rest("a person drove, handed back, and nothing is asked for", "why",
                        [](Situation&) {}, {"no goal is underway"}, {"keyboard", "does not want"}));
  const auto pressed = [](Situation& s) {
    stand(s);
    s.grant->role = v1::ROLE_ESTOP;
    s.grant->estopped = true;
    s.grant->estop_source = "panel";
  };
  all.push_back(while_driving("the emergency stop is pressed", "why", pressed,
                              {"EMERGENCY STOP, pressed by panel", "saphira estop reset"},
                              {"go_to"}));
  all.push_back(while_driving("the same, and it still rolls", "why",
                              [&](Situation& s) {
                                pressed(s);
                                s.robot->velocity = 0.35;
                              },
                              {"EMERGENCY STOP", "now it drives at 0.35 m/s"}));
  all.push_back(
      while_driving("the same", "why not faster", pressed, {"It does not go faster", "EMERGENCY"}));
  all.push_back(while_driving("the same", "drive", pressed, {"EMERGENCY STOP, pressed by panel"}));
  // The words of intentions (Executor, obey_estop).
  const auto ended = [](Situation& s) {
    s.goals = driving().goals;
    s.statuses = {goal_status(
        v1::GOAL_CANCELED, "emergency stop, pressed by \"panel\": ask anew once it is released")};
  };
  all.push_back(at_rest("the emergency stop was pressed, and is released", "why", ended,
                        {"canceled, emergency stop, pressed by \"panel\": ask anew once it is "
                         "released"},
                        {"saphira estop reset", "EMERGENCY"}));
  all.push_back(at_rest("the same, pressed again", "why",
                        [&](Situation& s) {
                          ended(s);
                          pressed(s);
                        },
                        {"EMERGENCY STOP, pressed by panel", "saphira estop reset"},
                        {"released since"}));
  all.push_back(while_driving("a script drives over drive/direct", "why",
                              [](Situation& s) {
                                by_keyboard(s, 0.25, 0.0);
                                s.grant->role = v1::ROLE_DIRECT;
                                s.grant->source = "saphira write";
                              },
                              {"saphira write drives it (direct)", "0.25 m/s"}, {"behaviors"}));
}

}  // namespace

std::vector<Case> good_cases() {
  std::vector<Case> all;
  all_is_well(all);
  goals(all);
  people(all);
  return all;
}

}  // namespace saphira::situation::test
