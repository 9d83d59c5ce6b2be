#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "saphira/bus/node.hpp"
#include "saphira/console/picture_flow.hpp"

namespace saphira::console {

/// The cameras' pictures, for the pages that look. Times: [s] of the gateway's clock.
class Cameras {
 public:
  explicit Cameras(bus::Node& node) : node_(node) {}

  /// Pictures are read while some page looks; otherwise the cameras are off.
  void set_watched(bool any);
  /// A robot state came.
  void heard(std::uint64_t cycle, double now);
  /// True where a picture has come.
  bool poll(double now);
  /// The message for a page that may get a picture now: a line of JSON, and the JPEG behind it.
  std::optional<std::string> next(PictureFlow& flow, PictureFlow::Lane lane, double now) const;

 private:
  /// When the newest picture was taken, by our clock.
  double captured() const;

  bus::Node& node_;
  std::optional<bus::Reader<v1::CameraPicture>> reader_;
  std::optional<v1::CameraPicture> picture_;
  std::uint64_t number_ = 0;  ///< of the newest picture, for the pages
  double came_ = 0.0;
  std::deque<std::pair<std::uint64_t, double>> cycles_;  ///< the newest ones, and when they came
};

}  // namespace saphira::console
