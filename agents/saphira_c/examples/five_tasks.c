/* Five micro-tasks that interrupt each other in turn (manual 6.5): each puts its work away, wakes
 * the next one, and sleeps. */
#include "saphira.h"

enum { WORK = 20 };
static const char* const kNames[5] = {"one", "two", "three", "four", "five"};
static int worked[5];

static void take_turn(int self) {
  switch (process_state) {
    case sfINIT:
      process_state = self == 0 ? (int)WORK : (int)sfSUSPEND;
      break;
    case sfRESUME:
      process_state = WORK;
      break;
    case WORK:
      if (++worked[self] % 3 == 0) {
        sfResumeProcess(sfFindProcess(kNames[(self + 1) % 5]));
        sfInterruptSelf();
      }
      break;
    case sfINTERRUPT:
      sfSMessage("%s puts its work away after %d cycles", kNames[self], worked[self]);
      process_state = sfSUSPEND;
      break;
  }
}
static void one(void) { take_turn(0); }
static void two(void) { take_turn(1); }
static void three(void) { take_turn(2); }
static void four(void) { take_turn(3); }
static void five(void) {
  take_turn(4);
  if (worked[4] == 6) exit(0);
}

static void connected(void) {
  sfInitBasicProcs();
  sfInitProcess(one, kNames[0]);
  sfInitProcess(two, kNames[1]);
  sfInitProcess(three, kNames[2]);
  sfInitProcess(four, kNames[3]);
  sfInitProcess(five, kNames[4]);
}

int main(void) {
  sfOnConnectFn(connected);
  sfStartup(0);
  return 0;
}
