#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "saphira/vision/picture.hpp"

namespace saphira::vision {

/// The pictures of a stereo socket (sim/README.md, Vision), read in a thread of its own, which
/// reconnects by itself.
class Pictures {
 public:
  /// An empty path: no pictures. `came` is called for every picture, in the reading thread.
  explicit Pictures(std::string path, std::function<void()> came = {});
  ~Pictures();

  /// The newest picture up to that cycle; drops earlier ones.
  std::optional<StereoPicture> take(std::uint64_t cycle);
  /// True where the picture of this cycle, or of a later one, has come.
  bool has(std::uint64_t cycle) const;
  bool connected() const;
  /// The reason why there are no pictures, in words; empty: they come.
  std::string trouble() const;

 private:
  void run();
  void read(int fd);
  void say(bool connected, std::string trouble);
  bool pause(int milliseconds) const;  ///< true where the end was asked for

  std::string path_;
  std::function<void()> came_;
  int stop_ = -1;  ///< an eventfd
  mutable std::mutex mutex_;
  std::deque<StereoPicture> pictures_;
  bool connected_ = false;
  std::string trouble_;
  std::thread thread_;
};

}  // namespace saphira::vision
