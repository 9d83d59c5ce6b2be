/* Turns and drives from the main program, beside the micro-tasks (manual 4.3.2 and 4.3.3). */
#include "saphira.h"

static void connected(void) {
  sfInitBasicProcs();
}

int main(void) {
  int degrees;
  sfOnConnectFn(connected);
  sfStartup(1);
  if (!sfConnectToRobot(sfLOCALPORT, sfCOMLOCAL)) return 1;
  for (degrees = 0; degrees <= 90; degrees += 45) {
    sfSetDHeading(degrees);
    while (!sfDoneHeading(5)) sfPause(0);
    printf("turned to %.0f degrees\n", sfNormAngle(sfRobot.ath) * 180.0 / 3.14159265);
  }
  sfSetVelocity(200);
  sfPause(2000);
  sfSetVelocity(0);
  sfPause(1000);
  printf("X: %.0f Y: %.0f\n", sfRobot.ax, sfRobot.ay);
  sfDisconnectFromRobot();
  return 0;
}
