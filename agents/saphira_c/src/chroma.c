/* The sample vision application (manual 9.3), and the intention of 8.1: by the public functions. */
#include "saphira.h"

enum { LOOK = 20, APPROACH = 21 };
#define CENTRED 10            /* [pixels] */
#define LOOK_CYCLES 200       /* 20 s */
#define STOP_RANGE 500        /* [mm] to the sonars' echo ahead */
#define STANDING 5            /* [mm/s]; slower is standing */
#define BLOCKED_CYCLES 20     /* 2 s */
#define TWO_FEET 609.6        /* [mm] */

static const struct vinfo* channel_of(int channel) {
  return channel == 0 ? &sfVaInfo : channel == 1 ? &sfVbInfo : channel == 2 ? &sfVcInfo : NULL;
}

static int is_seen(const struct vinfo* seen) {
  return seen != NULL && (seen->type == LINE_MODE ? seen->num > 0 : seen->area > 0);
}

void setup_vision_system(void) {
  char text[32];
  int channel;
  for (channel = 'a'; channel <= 'c'; ++channel) {
    snprintf(text, sizeof text, "pioneer_%c_mode=%d", channel, BLOB_BB_MODE);
    sfRobotComStr(VISION_COM, text);
  }
  sfRobotComStr(VISION_COM, "line_bottom_row=0");
  sfRobotComStr(VISION_COM, "line_num_slices=10");
  sfRobotComStr(VISION_COM, "line_slice_size=1");
  sfRobotComStr(VISION_COM, "line_min_mass=8");
}

int found_blob(int channel, int delta) {
  const struct vinfo* seen = channel_of(channel);
  return is_seen(seen) && abs(seen->x) <= delta ? seen->x : -1000;
}

void draw_blobs(void) {
  static const int colors[] = {sfColorRed, sfColorDarkOliveGreen, sfColorSteelBlue};
  int channel;
  if (process_state == sfINTERRUPT) {
    process_state = sfSUSPEND;
    return;
  }
  for (channel = 0; channel < 3; ++channel) {
    const struct vinfo* seen = channel_of(channel);
    double pixels, range, bearing, size;
    if (!is_seen(seen)) continue;
    /* Left is positive in the LPS; image pixels count to the right. */
    pixels = seen->w > 0 ? seen->w : sqrt((double)seen->area);
    if (pixels < 1.0) pixels = 1.0;
    range = TWO_FEET / tan(pixels / DEG_TO_PIXELS * 3.14159265 / 180.0);
    if (!(range > 0.0) || range > 10000.0) range = 10000.0;
    bearing = -seen->x / DEG_TO_PIXELS * 3.14159265 / 180.0;
    size = 10.0 * sqrt((double)seen->area);
    sfSetPatchColor(colors[channel]);
    sfDrawCenteredRect((float)(range * cos(bearing)), (float)(range * sin(bearing)), (float)size,
                       (float)size);
  }
  process_state = LOOK;
}

void find_blob(void) {
  process* self = sf_intention_self;
  static int left;
  switch (process_state) {
    case sfINIT:
    case sfRESUME:
      left = LOOK_CYCLES;
      sfSetVelocity(0);
      sfSetRVelocity(20);
      process_state = LOOK;
      break;
    case LOOK:
      if (found_blob(0, CENTRED) != -1000) {
        sfSetRVelocity(0);
        process_state = sfSUCCESS;
      } else if (--left <= 0) {
        sfSetRVelocity(0);
        process_state = sfFAILURE;
      }
      break;
    case sfINTERRUPT:
      sfSetRVelocity(0);
      process_state = sfSUSPEND;
      break;
  }
  (void)self;
}

void search_and_go_blob(void) {
  static process* search;
  static int blocked;
  int x;
  switch (process_state) {
    case sfINIT:
    case sfRESUME:
      blocked = 0;
      search = sfInitIntention(find_blob, "find blob", 0, sfEND);
      process_state = LOOK;
      break;
    case LOOK:
      if (search == NULL || search->state == sfFAILURE || search->state == sfREMOVE) {
        process_state = sfFAILURE;
      } else if (search->state == sfSUCCESS) {
        search->state = sfREMOVE;
        sfSetVelocity(150);
        process_state = APPROACH;
      }
      break;
    case APPROACH:
      x = found_blob(0, 100);
      /* The robot's guard stops it before a blob that is too thin for an echo. */
      blocked = abs((int)sfRobot.tv) < STANDING ? blocked + 1 : 0;
      if (sfOccPlane(sfFRONT, sfFRONT, 100, 300, 300) <= STOP_RANGE ||
          (x != -1000 && blocked > BLOCKED_CYCLES)) {
        sfSetVelocity(0);
        sfSetRVelocity(0);
        process_state = sfSUCCESS;
      } else if (x == -1000) {
        sfSetVelocity(0);
        sfSetRVelocity(0);
        process_state = sfINIT;
      } else {
        sfSetRVelocity((int)(-x / DEG_TO_PIXELS));
      }
      break;
    case sfINTERRUPT:
      if (search != NULL) search->state = sfREMOVE;
      sfSetVelocity(0);
      sfSetRVelocity(0);
      process_state = sfSUSPEND;
      break;
  }
}

/* 8.1: follows the robot's corridor, until it ends or the robot turns off it. */
enum { FOLLOW_CORRIDOR = 10, WAIT_REMOVE = 11, CHECK_CORRIDOR = 20 };

void sfFindAndFollow(void) {
  static point follow_target;
  static point* e;
  static process* p;
  beh_params par;
  switch (process_state) {
    case sfINIT:
    case sfRESUME:
      p = NULL;
      sfAddPointCheck(&follow_target);
      process_state = CHECK_CORRIDOR;
      break;
    case CHECK_CORRIDOR:
      if (current_environment == NULL || current_environment->type != CORRIDOR) break;
      e = current_environment;
      follow_target.x = 10000.0F;
      follow_target.y = 0.0F;
      par = beh_alloc(7);
      if (par == NULL) break;
      FOL_LANE(par) = current_environment;
      FOL_TARGET(par) = &follow_target;
      p = intend_beh(sfFollowCorridor, "follow it", 0, par, 2);
      process_state = FOLLOW_CORRIDOR;
      break;
    case FOLLOW_CORRIDOR:
      if (current_environment != e || finished(p) ||
          aligned_in_lane(e, &follow_target, 80.0, 110.0) < 0.5F) {
        process_state = WAIT_REMOVE;
        if (p != NULL) p->state = sfREMOVE;
        p = NULL;
      }
      break;
    case WAIT_REMOVE:
      process_state = CHECK_CORRIDOR;
      break;
    case sfINTERRUPT:
      if (p != NULL) p->state = sfREMOVE;
      p = NULL;
      process_state = sfSUSPEND;
      break;
  }
}
