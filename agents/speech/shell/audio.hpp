#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "saphira/speech/sound.hpp"

namespace saphira::speech {

/// The reason why the device cannot be opened; empty: it can, it is in use, or it is no device of
/// ALSA.
std::string microphone_trouble(const std::string& source);
std::string speaker_trouble(const std::string& sink);

/// The source of sound: a device of ALSA, a WAV file, `-` or a FIFO with raw samples (16 bits, 16
/// kHz, one channel), or `none`. Reads in a thread of its own; the queue holds a few seconds at
/// most, and a device's older sound is lost.
class Microphone {
 public:
  /// `trouble` gets, from the thread, the reason for missing sound; an empty text: it comes again.
  /// A failed device is tried again. UnusableFile for a file without sound.
  Microphone(std::string source, std::function<void(const std::string&)> trouble);
  ~Microphone();

  Sound take();
  /// True at the end of a file, with an empty queue.
  bool ended() const;
  /// True while a device gives no sound, and no error either.
  bool hangs() const;

 private:
  void run();
  void read_once();
  void read_device();
  void read_pipe(int file);
  void put(const Sound& sound, bool waits);
  void rest();

  std::string source_;
  std::function<void(const std::string&)> trouble_;
  mutable std::mutex mutex_;
  std::condition_variable taken_;
  bool at_end_;
  Sound waiting_;
  std::optional<std::chrono::steady_clock::time_point> due_{};  ///< the next sound of a device
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The target of sound: a device of ALSA, a folder (a WAV file for each), or `none`. Plays in a
/// thread of its own.
class Speaker {
 public:
  Speaker(std::string sink, std::function<void(const std::string&)> trouble);
  ~Speaker();

  void play(Sound sound);
  /// True while it plays. A device that hangs does not: the robot hears on.
  bool speaking() const;
  bool hangs() const;

 private:
  void run();
  void play_once(const Sound& sound);
  void play_on_device(const Sound& sound) const;

  std::string sink_;
  std::function<void(const std::string&)> trouble_;
  mutable std::mutex mutex_;
  std::condition_variable more_;
  std::deque<Sound> waiting_;
  bool stop_ = false;
  bool speaking_ = false;
  std::chrono::steady_clock::time_point due_;  ///< the end of what it plays
  int files_ = 0;
  std::thread thread_;
};

}  // namespace saphira::speech
