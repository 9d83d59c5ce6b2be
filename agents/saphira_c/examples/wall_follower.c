/* Follows the wall to its left: a behavior with fuzzy rules (manual 7.6), with lower priority than
 * a library behavior that avoids obstacles. */
#include "saphira.h"

extern int Accel, Decel, Turn_left, Turn_right;

enum { TOO_FAR, TOO_NEAR, TOO_SLOW, TOO_FAST, TURN, FASTER, SLOWER }; /* in beh_state */
#define DISTANCE(params) (params)[0].f
#define SPEED(params) (params)[1].f

static void follow_init(beh_params params) {
  sfSMessage("follows the wall at %.0f mm", DISTANCE(params));
}

static void follow_update(beh_params params) {
  const float off = (float)sfOccPlane(sfLEFT, sfSIDES, 100, 600, 600) - DISTANCE(params);
  const float v = sfRobot.tv - SPEED(params);
  beh_state[TOO_FAR] = straight_up(off, 50.0F, 400.0F);
  beh_state[TOO_NEAR] = straight_up(-off, 50.0F, 300.0F);
  /* No wall at all: straight on. */
  if (off > 2000.0F) beh_state[TOO_FAR] = 0.0F;
  beh_state[TURN] = 15.0F;
  beh_state[TOO_SLOW] = straight_up(-v, 0.0F, 100.0F);
  beh_state[TOO_FAST] = straight_up(v, 0.0F, 100.0F);
  beh_state[FASTER] = beh_state[SLOWER] = 100.0F;
}

static behavior follow_wall = {"Follow wall",
                               follow_init,
                               follow_update,
                               2,
                               4,
                               {{"to the wall", TOO_FAR, &Turn_left, TURN},
                                {"from the wall", TOO_NEAR, &Turn_right, TURN},
                                {"speed up", TOO_SLOW, &Accel, FASTER},
                                {"slow down", TOO_FAST, &Decel, SLOWER}}};

static void connected(void) {
  sfInitBasicProcs();
  sfInitControlProcs();
  sfInitBehavior(sfAvoidCollision, 0, sfON, sfFLOAT, 1.5, sfFLOAT, 1.0, sfFLOAT, 6.0, sfFLOAT,
                 100.0, sfEND);
  sfInitBehavior(&follow_wall, 1, sfON, sfFLOAT, 800.0, sfFLOAT, 200.0, sfEND);
}

int main(void) {
  sfOnConnectFn(connected);
  sfStartup(0);
  return 0;
}
