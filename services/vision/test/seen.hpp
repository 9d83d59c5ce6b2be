#pragma once

#include <string>

#include "saphira/sim/scene.hpp"
#include "saphira/sim/stereo.hpp"
#include "saphira/sim/vision.hpp"
#include "saphira/vision/blobs.hpp"
#include "saphira/vision/people.hpp"
#include "saphira/vision/picture.hpp"

/// Simulated pictures for the tests.
namespace saphira::vision {

/// A room of 10 x 6 m with things in it.
inline sim::World room(const std::string& things) {
  return sim::parse_world(
      "width 10000 height 6000 0 0 0 6000 0 0 10000 0 0 6000 10000 6000 10000 0 10000 6000 " +
          things,
      "room.wld");
}

/// The view of a robot's cameras, as it comes over the line.
inline StereoPicture picture(const sim::Scene& scene, Random& random, std::uint64_t cycle = 1) {
  const sim::StereoRig rig;
  PictureStream stream;
  stream.feed(sim::to_pgm(sim::render_stereo(scene, 0, rig, random), rig, cycle));
  return stream.take().value();
}

inline Bands bands(Census& census, const StereoPicture& picture) {
  const auto [first, last] = torso_rows(picture.rig, picture.rows);
  return bands_of(census.match(picture.left(), picture.right(), first, last), picture.rig,
                  picture.rows);
}

/// The ranges that a robot in such a room measures.
inline Bands bands_of(const std::string& things, const Pose& robot = {2.0, 3.0, 0.0}) {
  const sim::World world = room(things);
  sim::Scene scene(world);
  scene.add_robot({}, robot, 1);
  Random random(5);
  Census census;
  return bands(census, picture(scene, random));
}

}  // namespace saphira::vision
