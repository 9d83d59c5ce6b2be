/* Talks to the robot server without the OS (manual 4.3.5). */
#include "saphira.h"

int main(void) {
  int i = 0;
  if (!sfConnectToRobot(sfLOCALPORT, sfCOMLOCAL)) return 1;
  sfRobotComInt(sfCOMOPEN, 1);
  sfResetRobotVars();
  while (i < 30) {
    if (i % 10 == 0) {
      sfRobotCom(sfCOMPULSE);
      sfRobotComInt(sfCOMVEL, 200);
    }
    if (!sfWaitClientPacket(1000)) continue;
    sfProcessClientPacket();
    if (++i % 10 == 0) printf("%d packets, X: %.0f\n", i, sfRobot.ax);
  }
  sfRobotComInt(sfCOMVEL, 0);
  sfDisconnectFromRobot();
  return 0;
}
