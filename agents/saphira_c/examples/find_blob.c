/* Turns until the camera's channel A sees its colour ahead, and goes there (manual 9.3). */
#include "saphira.h"

static process* search;

static void watch(void) {
  if (finished(search)) {
    sfSMessage("the search has ended: %s",
               search->state == sfSUCCESS ? "at the blob" : "there is no blob");
    process_state = sfSUSPEND;
  }
}

static void connected(void) {
  sfInitBasicProcs();
  sfInitControlProcs();
  setup_vision_system();
  sfInitProcess(draw_blobs, "draw blobs");
  search = sfInitIntention(search_and_go_blob, "search and go", 0, sfEND);
  sfInitProcess(watch, "watch");
}

int main(void) {
  sfOnConnectFn(connected);
  sfStartup(0);
  return 0;
}
