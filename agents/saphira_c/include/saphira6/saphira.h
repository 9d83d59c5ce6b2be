/* saphira.h for programs that were written for Saphira 6: its names beside those of the manual 5.3,
 * all angles in degrees, and basic processes that begin with the connection. docs/c-api.md says
 * what differs. */
#ifndef SAPHIRA_6_H
#define SAPHIRA_6_H

#include "../saphira.h"

#ifdef __cplusplus
extern "C" {
#endif

#ifndef IS_UNIX
#define IS_UNIX 1
#endif
typedef process sfprocess;

#define sfRadToDeg(angle) ((angle) * (180.0 / 3.14159265358979323846))
#define sfDegToRad(angle) ((angle) * (3.14159265358979323846 / 180.0))

enum { sfLINESOLID = 0, sfLINEDASHED = 1 };

/* The evaluator of Colbert. There is none here: the process suspends itself. */
static inline void sfRunEvaluator(void) {
  process_state = sfSUSPEND;
}

static inline int sf_occ_box_ret6(int xy, int cx, int cy, int h, int w, float* x, float* y) {
  int at_x = (int)*x, at_y = (int)*y;
  const int range = sfOccBoxRet(xy, cx, cy, h, w, &at_x, &at_y);
  *x = (float)at_x;
  *y = (float)at_y;
  return range;
}
static inline int sf_occ_plane_ret6(int xy, int source, int d, int s1, int s2, float* x, float* y) {
  int at_x = (int)*x, at_y = (int)*y;
  const int range = sfOccPlaneRet(xy, source, d, s1, s2, &at_x, &at_y);
  *x = (float)at_x;
  *y = (float)at_y;
  return range;
}
#define sfOccBoxRet sf_occ_box_ret6
#define sfOccPlaneRet sf_occ_plane_ret6

__attribute__((constructor)) static void sf_begin_as_saphira6(void) {
  sf_as_saphira6();
}

#ifdef __cplusplus
}
#endif
#endif
