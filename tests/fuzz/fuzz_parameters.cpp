// A robot parameter file: it loads or gives a FileError, and loaded parameters keep their
// guarantees.

#include <cmath>

#include "fuzz.hpp"
#include "saphira/protocol/parameters.hpp"

void saphira::fuzz::run(std::string_view text) {
  reads([&] {
    const auto p = saphira::protocol::parse_parameters(text, "fuzz.p");
    bool good = p.angle_unit > 0.0 && p.distance_unit > 0.0 && p.velocity_unit > 0.0 &&
                p.range_unit > 0.0 && p.vel2_unit > 0.0 && p.radius > 0.0 && p.max_velocity > 0.0 &&
                p.sonars.size() <= 64;
    for (std::size_t i = 0; i < p.sonars.size(); ++i)
      good = good && p.sonars[i].number == i && std::isfinite(p.sonars[i].pose_in_robot.x);
    for (const std::string& name : saphira::protocol::parameter_file_names(text, p.subclass))
      good = good && name.find('/') == std::string::npos;
    require(good);
  });
}
