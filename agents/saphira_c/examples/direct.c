/* Drives two metres to and fro: a micro-task with direct motion commands (manual 4.3.1). */
#include "saphira.h"

enum { GO = 20, WAIT = 21, BACK = 22, WAIT_BACK = 23 };

static void patrol(void) {
  switch (process_state) {
    case sfINIT:
    case sfRESUME: /* suspended earlier, and resumed */
      process_state = GO;
      break;
    case GO:
      sfSetPosition(2000);
      process_state = WAIT;
      break;
    case WAIT:
      if (sfDonePosition(100)) process_state = BACK;
      break;
    case BACK:
      sfSetPosition(-2000);
      process_state = WAIT_BACK;
      break;
    case WAIT_BACK:
      if (sfDonePosition(100)) process_state = GO;
      break;
  }
}

static void connected(void) {
  sfInitBasicProcs();
  sfSetMaxVelocity(300);
  sfInitProcess(patrol, "patrol");
  sfMessage("patrols");
}

int main(void) {
  sfOnConnectFn(connected);
  sfStartup(0);
  return 0;
}
