#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "saphira/bus/introspect.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/bus/request_client.hpp"
#include "saphira/cli/second_deployment.hpp"
#include "saphira/cli/words.hpp"

namespace saphira::cli {

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

/// Keeps the newest status of every process.
class Processes {
 public:
  explicit Processes(bus::Node& node) : node_(node), reader_(node.reader(bus::topics::kStatus)) {}

  void poll();
  std::vector<SeenProcess> all() const;
  bool heard_any() const { return !entries_.empty(); }
  /// Rises with each program that is noticed, and again when it is heard.
  std::size_t news() const { return reader_.matched() + entries_.size(); }
  /// [s] since that has changed.
  double quiet() const { return seconds_since(changed_); }
  /// The part of the robot's situation that comes from the status, without cyclic topics.
  situation::Situation situation() const;
  /// Of all seen processes, including ended ones.
  std::uint64_t late_cycles() const;
  const bus::Node& node() const { return node_; }

 private:
  struct Entry {
    v1::ServiceStatus status;
    Clock::time_point came;
    bool gone = false;  ///< after a clean end
    int samples = 0;
    double age = 0.0;  ///< [s] least age of a sample, by the clocks of both machines
  };
  const bus::Node& node_;
  bus::Reader<v1::ServiceStatus> reader_;
  std::map<std::uint64_t, Entry> entries_;
  Clock::time_point began_ = Clock::now();
  std::size_t news_ = 0;
  Clock::time_point changed_ = began_;
};

/// Warns once when two deployments have this robot, in any command.
class DeploymentWatch {
 public:
  DeploymentWatch(bus::Node& node, Processes& processes) : node_(node), processes_(processes) {}

  /// Polls the processes as well.
  void poll();
  /// For the end of a command: waits until a second deployment is confirmed or excluded.
  void settle(const bus::Stop& stop);

 private:
  bus::Node& node_;
  Processes& processes_;
  SecondDeployment second_;
};

/// The profile's word: host, lan, wan.
const char* name_of(bus::Profile profile);

/// A program of this name and its user, for people: "keyboard of ann at laptop (pts/3)"; with
/// `since`, also the time of this call: "(pts/3, since 14:02)".
std::string person(const std::string& program, bool since = false);

/// In place of a robot's name.
inline constexpr const char* kEveryRobot = "*";
/// "robot flakey", or "every robot".
std::string called(const std::string& robot);
/// The robots of the domain with a program that `tells`; they are listened for.
std::set<std::string> robots_heard(const bus::NodeOptions& options, const bus::Stop& stop,
                                   const std::function<bool(const bus::EndpointEntry&)>& tells);

constexpr double kEmptyBus = 5.0;  ///< [s] until a question is given up where no program is heard

/// The missing or troubled programs, in words, for requests without an answer.
std::string who_is_there(const Processes& processes);

/// The program that answers requests on agents/solve.
inline constexpr const char* kFacilitator = "facilitator";

/// The time after which every living program has reported that was noticed: the status comes once a
/// second. Where nobody was heard, other machines may still be on their way.
std::chrono::milliseconds listening_time(const bus::Node& node, bool heard = true);
/// Polls until `news`, which rises with all that is noticed and heard, has stayed the same for that
/// time: on a slow network later. For 10 s at most. Returns the time of the newest [s].
double listen(bus::Node& node, const bus::Stop& stop, const Processes& processes,
              const std::function<void()>& poll, const std::function<std::size_t()>& news);

/// That this program is not heard, in words. Empty: it is, or may not have reported yet.
std::string absence(const bus::Node& node, const Processes& processes, const std::string& program);

/// RequestClient::ask, on a topic that only this program answers. Where it is not on the bus, that
/// ends it at once, and is the text of the answer.
v1::Answer ask_program(const std::string& program, bus::Node& node, bus::RequestClient& client,
                       const v1::Request& request, double patience, const bus::Stop& stop,
                       Processes& processes, const std::function<void()>& meanwhile = {});

}  // namespace saphira::cli
