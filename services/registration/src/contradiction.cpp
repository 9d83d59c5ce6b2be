#include "saphira/registration/contradiction.hpp"

#include <cmath>

namespace saphira::registration {

double contradiction(const Field& field, const Pose& sensor_in_map, double range, bool echo,
                     const ContradictionSettings& settings) {
  const Field::Nearest nearest = field.nearest(sensor_in_map.position());
  if (nearest.distance > settings.range ||
      nearest.towards.dot(sensor_in_map.direction()) < std::cos(settings.facing))
    return 0.0;
  if (!echo)
    return settings.silent;
  const double off = std::abs(range - nearest.distance);
  return off < settings.exact   ? settings.agrees
         : off < settings.rough ? settings.differs
                                : settings.denies;
}

}  // namespace saphira::registration
