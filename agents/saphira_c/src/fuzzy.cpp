// Fuzzy variables (manual 7.5).

#include "saphira/behaviors/fuzzy.hpp"

#include "saphira.h"

namespace fuzzy = saphira::behaviors;

extern "C" {

float straight_up(float x, float min, float max) {
  return static_cast<float>(fuzzy::straight_up(x, min, max));
}
float down_straight(float x, float min, float max) {
  return static_cast<float>(fuzzy::down_straight(x, min, max));
}
float f_greater(float x, float c, float delta) {
  return static_cast<float>(fuzzy::f_greater(x, c, delta));
}
float f_smaller(float x, float c, float delta) {
  return static_cast<float>(fuzzy::f_smaller(x, c, delta));
}
float f_eq(float x, float c, float delta) {
  return static_cast<float>(fuzzy::f_eq(x, c, delta));
}
float f_not(float x) {
  return static_cast<float>(fuzzy::f_not(x));
}
float f_and(float x, float y) {
  return static_cast<float>(fuzzy::f_and(x, y));
}
float f_or(float x, float y) {
  return static_cast<float>(fuzzy::f_or(x, y));
}

}  // extern "C"
