#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "saphira/bus/node.hpp"
#include "saphira/situation/situation.hpp"

namespace saphira::watch {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point when) {
  return std::chrono::duration<double>(Clock::now() - when).count();
}

/// Waits for the node's samples and polls, for that time.
template <class Poll>
void poll_for(bus::Node& node, std::chrono::milliseconds time, const bus::Stop& stop, Poll poll) {
  const auto end = Clock::now() + time;
  while (!stop.requested() && Clock::now() < end) {
    node.wait(std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()), &stop);
    poll();
  }
}

/// Waits for the node's samples, for that time at most, until `ready()`, which polls. True: it is.
template <class Ready>
bool wait_for(bus::Node& node, std::chrono::duration<double> time, const bus::Stop& stop,
              Ready ready) {
  bool is = ready();
  for (const auto end = Clock::now() + time; !is && !stop.requested() && Clock::now() < end;
       is = ready())
    node.wait(std::chrono::milliseconds(50), &stop);
  return is;
}

/// Takes the reader's samples: of each instance that is there the newest, by `key` of the sample.
template <class T, class Samples, class Key>
void keep_newest(bus::Reader<T>& reader, Samples& samples, Key key) {
  for (const auto& sample : reader.take()) {
    if (sample.info.disposed)
      samples.erase(key(sample.data));
    else
      samples[key(sample.data)] = sample.data;
  }
}

/// The newest sample of a topic without instances.
template <class T>
class Newest {
 public:
  Newest(bus::Node& node, const bus::Topic<T>& topic) : reader_(node.reader(topic)) {}

  /// True where one has come.
  bool poll() {
    auto sample = reader_.take_newest();
    if (!sample)
      return false;
    sample_ = std::move(sample);
    return true;
  }
  /// Null: none has come.
  const T* get() const { return sample_ ? &*sample_ : nullptr; }
  explicit operator bool() const { return sample_.has_value(); }
  const T& operator*() const { return *sample_; }
  const T* operator->() const { return &*sample_; }
  /// Writers.
  std::size_t matched() const { return reader_.matched(); }

 private:
  bus::Reader<T> reader_;
  std::optional<T> sample_;
};

/// Keeps the newest status of every process.
class Processes {
 public:
  explicit Processes(bus::Node& node) : node_(node), reader_(node.reader(bus::topics::kStatus)) {}

  void poll();
  std::vector<situation::Program> all() const;
  bool heard_any() const { return !entries_.empty(); }
  /// Rises with each program that is noticed, and again when it is heard.
  std::size_t news() const { return reader_.matched() + entries_.size(); }
  /// [s] since that has changed.
  double quiet() const { return seconds_since(changed_); }
  /// The part of the robot's situation that comes from the status, without cyclic topics.
  situation::Situation situation() const;
  /// Those that discovery has found in the last seconds, and whose status has not come yet, or is
  /// late on a network.
  std::vector<std::string> found() const;
  /// Of all seen processes, including ended ones.
  std::uint64_t late_cycles() const;
  bus::Node& node() const { return node_; }

 private:
  struct Entry {
    v1::ServiceStatus status;
    Clock::time_point came;
    bool gone = false;  ///< after a clean end
    int samples = 0;
    double age = 0.0;  ///< [s] least age of a sample, by the clocks of both machines
  };
  bus::Node& node_;
  bus::Reader<v1::ServiceStatus> reader_;
  std::map<std::uint64_t, Entry> entries_;
  Clock::time_point began_ = Clock::now();
  std::size_t news_ = 0;
  Clock::time_point changed_ = began_;
};

/// The profile's word: host, lan, wan.
const char* name_of(bus::Profile profile);

/// The programs of this robot are those of a recording, which saphira replay plays.
bool is_recording(const Processes& processes);

/// The missing or troubled programs, in words, for requests without an answer.
std::string who_is_there(const Processes& processes);

/// The time after which every living program has reported that was noticed: the status comes once a
/// second. Where nobody was heard, other machines may still be on their way.
std::chrono::milliseconds listening_time(const bus::Node& node, bool heard = true);
/// Polls until `news`, which rises with all that is noticed and heard, has stayed the same for that
/// time: on a slow network later. For 10 s at most, on a network 15. Returns the time of the newest
/// [s].
double listen(bus::Node& node, const bus::Stop& stop, const Processes& processes,
              const std::function<void()>& poll, const std::function<std::size_t()>& news);

/// That this program is not heard, in words. Empty: it is, or may not have reported yet.
std::string absence(const bus::Node& node, const Processes& processes, const std::string& program);

}  // namespace saphira::watch
