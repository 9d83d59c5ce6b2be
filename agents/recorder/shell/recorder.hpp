#pragma once

#include <cstdint>
#include <istream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "saphira/bus/introspect.hpp"
#include "saphira/bus/node.hpp"
#include "saphira/recorder/recording.hpp"
#include "saphira/viewer/scene.hpp"

namespace saphira::recorder {

inline constexpr double kGridPeriod = 10.0;  ///< [s] between two drawn grids, which are large

/// The topics of this contract that a recording holds; `only`: those among these names, if there is
/// any. The topics recall/... repeat what others have said. std::invalid_argument: an unknown name.
std::vector<bus::TopicEntry> recorded_topics(const std::vector<std::string>& only);

/// Writes the samples of topics to a recording, and what viewers draw of them (viewer::Scene). For
/// the thread that waits on the node.
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
    std::string topic;
    std::uint16_t channel;
  };
  Writer& writer_;
  viewer::Scene scene_;
  std::vector<std::uint16_t> drawn_;  ///< channels of viewer::drawn_channels()
  bool has_heard_ = false;
  std::vector<Source> sources_;
  std::vector<std::string> refused_;
};

/// The content of a recording.
struct Contents {
  std::map<std::string, std::uint64_t> samples;  ///< by topic
  std::string robot;
  std::int64_t first_ns = 0;  ///< of the first sample
  double seconds = 0.0;       ///< without steps of the recorder's clock (Player::Gap)
  bool cut_off = false;
};

/// std::invalid_argument: as Reader.
Contents contents_of(std::istream& in);

/// Writes a recording's samples to their topics, in the order of the file. Commands are left out:
/// nothing may drive by a recording.
class Player {
 public:
  struct Options {
    std::set<std::string> only;  ///< these topics [empty: all]
    double from = 0.0;           ///< [s] into the recording. Of what was before, kept topics
                                 ///< (latched, status) come, and come at once
  };
  /// A step of the recorder's clock, which the player does not wait for.
  struct Gap {
    double at = 0.0;    ///< [s] into the recording
    double step = 0.0;  ///< [s] to the next sample; less than 0: back
  };

  /// `contents`: of the same recording. Topics that this contract does not know are left out.
  /// std::invalid_argument: it ends before `from`.
  Player(bus::Node& node, Reader& reader, const Contents& contents, const Options& options);

  /// Writes the samples of the next `seconds`. False: it has ended. std::invalid_argument: as
  /// Reader, or a sample of another contract.
  bool poll(double seconds);
  std::uint64_t written() const { return written_; }
  const std::set<std::string>& left_out() const { return left_out_; }
  /// Those since the last call.
  std::vector<Gap> take_gaps() { return std::exchange(gaps_, {}); }

 private:
  void write(const std::string& topic, const std::string& json);

  Reader& reader_;
  std::optional<std::int64_t> last_ns_;  ///< of the newest sample
  std::int64_t due_ns_ = 0;              ///< of the waiting sample, into the recording without gaps
  std::int64_t played_ns_;               ///< likewise
  std::int64_t from_ns_;
  std::map<std::string, bus::Scribe> scribes_;
  std::set<std::string> kept_;  ///< topics that are kept for readers who come later
  std::set<std::string> left_out_;
  std::vector<Gap> gaps_;
  std::optional<Sample> waiting_;
  std::uint64_t written_ = 0;
};

}  // namespace saphira::recorder
