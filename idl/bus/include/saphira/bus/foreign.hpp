#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "saphira/bus/endpoint.hpp"

namespace saphira::bus {

/// A topic of programs that are not of this project, such as those of ROS 2: in no partition,
/// without keys.
struct ForeignTopic {
  std::string name;  ///< as on the wire, such as rt/odom
  std::string type;  ///< likewise, such as nav_msgs::msg::dds_::Odometry_
  bool reliable = true;
  bool transient_local = false;
  int depth = 10;
  std::string user_data{};  ///< of the endpoint
};

/// A sample among those of all writers; an answer names that of its request.
struct SampleId {
  WriterId writer{};
  std::uint64_t number = 0;
};

struct ForeignSample {
  std::string bytes;  ///< CDR with its encapsulation
  SampleId id;
  SampleId related;  ///< as the writer gave it
};

/// A participant of its own for such topics, over UDP. Samples are bytes.
class Foreign {
 public:
  struct Options {
    std::uint32_t domain = 0;
    std::string name{};
    std::string interface {};  ///< address of the one interface to use [empty: all]
    std::string user_data{};
  };
  /// `wake` is called, from any thread, when a sample has come. std::runtime_error names the cause.
  Foreign(const Options& options, std::function<void()> wake);
  ~Foreign();

  WriterId id() const;

  /// An endpoint ends with its object, and not after the participant.
  class Writer {
   public:
    virtual ~Writer() = default;
    /// `answers`: the request's. False where the sample was not taken.
    virtual bool write(const std::string& bytes, const SampleId* answers = nullptr) = 0;
    virtual std::size_t matched() const = 0;
    virtual WriterId id() const = 0;
  };
  class Reader {
   public:
    virtual ~Reader() = default;
    /// The samples since the last call, oldest first.
    virtual std::vector<ForeignSample> take() = 0;
    virtual std::size_t matched() const = 0;
    virtual WriterId id() const = 0;
  };
  std::unique_ptr<Writer> writer(const ForeignTopic& topic);
  std::unique_ptr<Reader> reader(const ForeignTopic& topic);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace saphira::bus
