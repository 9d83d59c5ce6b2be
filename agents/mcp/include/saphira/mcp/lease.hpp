#pragma once

namespace saphira::mcp {

/// The presence of a client that connects anew for each request: without it its goals end. Pure:
/// times are [s] of any clock that never goes back.
class Lease {
 public:
  explicit Lease(double now) : seen_(now) {}

  /// A request has come.
  void came(double now) {
    seen_ = now;
    broken_ = false;
  }
  /// The client has closed a connection before the end of its answer or stream, as a killed one
  /// does.
  void broke(double now) {
    seen_ = now;
    broken_ = true;
  }
  /// connected: a request or stream is open. busy: a goal of the client is underway.
  bool is_over(double now, bool connected, bool busy) {
    if (connected)
      seen_ = now;
    return now - seen_ >= (broken_ && busy ? kBroken : kSilent);
  }

  static constexpr double kSilent = 30.0;  ///< [s]
  /// [s] enough for a client that connects again after a second, and for a robot that has to stand
  /// 3 s after a kill.
  static constexpr double kBroken = 1.5;

 private:
  double seen_;
  bool broken_ = false;
};

}  // namespace saphira::mcp
