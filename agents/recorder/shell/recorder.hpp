#pragma once

#include <cstdint>
#include <istream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "saphira/bus/introspect.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/recorder/recording.hpp"

namespace saphira::recorder {

/// The topics of this contract that a recording holds; `only`: those among these names, if there is
/// any. The topics recall/... repeat what others have said. std::invalid_argument: an unknown name.
std::vector<bus::TopicEntry> recorded_topics(const std::vector<std::string>& only);

/// Writes the samples of topics to a recording. For the thread that waits on the node.
class Recorder {
 public:
  Recorder(bus::Node& node, Writer& writer, const std::vector<bus::TopicEntry>& topics);

  /// Takes the new samples. `now_ns`: since 1970.
  void poll(std::int64_t now_ns);
  /// Topics that this program may not read, each with the reason.
  const std::vector<std::string>& refused() const { return refused_; }
  /// Something was said besides the presence of programs, which the recorder's own is among.
  bool has_heard() const { return has_heard_; }

 private:
  struct Source {
    std::unique_ptr<bus::Echo> echo;
    std::uint16_t channel;
    bool is_presence;
  };
  Writer& writer_;
  bool has_heard_ = false;
  std::vector<Source> sources_;
  std::vector<std::string> refused_;
};

/// The content of a recording.
struct Contents {
  std::map<std::string, std::uint64_t> samples;  ///< by topic
  std::string robot;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  bool cut_off = false;
};

/// std::invalid_argument: as Reader.
Contents contents_of(std::istream& in);

/// Writes a recording's samples to their topics. Commands are left out: nothing may drive by a
/// recording.
class Player {
 public:
  /// `contents`: of the same recording. Topics that this contract does not know are left out.
  Player(bus::Node& node, Reader& reader, const Contents& contents);

  /// Writes the samples of the recording's first `seconds`. False: it has ended.
  /// std::invalid_argument: as Reader, or a sample of another contract.
  bool poll(double seconds);
  std::uint64_t written() const { return written_; }
  const std::set<std::string>& left_out() const { return left_out_; }

 private:
  Reader& reader_;
  std::int64_t first_ns_;
  std::map<std::string, bus::Scribe> scribes_;
  std::set<std::string> left_out_;
  std::optional<Sample> waiting_;
  std::uint64_t written_ = 0;
};

}  // namespace saphira::recorder
