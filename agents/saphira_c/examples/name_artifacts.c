/* Names the artifacts that it passes: its own points, seen walls, and the map's. */
#include "saphira.h"

static point* goal;

static void name_artifacts(void) {
  static int told_goal, told_wall;
  static point* told_place;
  if (process_state == sfINIT) {
    goal = sfCreateLocalPoint(1000.0F, 0.0F, 0.0F);
    sfAddPointCheck(goal);
    sfSetVelocity(200);
    process_state = 20;
  }
  if (!told_goal && sfPointXo(goal) > 0.0F) {
    sfSMessage("passed the goal, %.0f mm from it", sfPointDist(goal));
    told_goal = 1;
  }
  if (!told_wall && (sfLeftWallHyp.viewable || sfRightWallHyp.viewable)) {
    const wall* seen = sfLeftWallHyp.viewable ? &sfLeftWallHyp : &sfRightWallHyp;
    sfSMessage("a wall of %.0f mm to the %s", seen->length, seen->y > 0.0F ? "left" : "right");
    told_wall = 1;
  }
  if (current_environment != told_place && current_environment != NULL)
    sfSMessage("in %s %d",
               current_environment->type == CORRIDOR   ? "corridor"
               : current_environment->type == JUNCTION ? "junction"
                                                       : "place",
               current_environment->id);
  told_place = current_environment;
}

static void connected(void) {
  sfInitBasicProcs();
  sfInitInterpretationProcs();
  sfInitRegistrationProcs();
  sfInitProcess(name_artifacts, "name artifacts");
}

int main(void) {
  sfOnConnectFn(connected);
  sfStartup(0);
  return 0;
}
