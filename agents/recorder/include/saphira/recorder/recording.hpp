#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace saphira::recorder {

/// A topic of a recording.
struct Channel {
  std::string topic;  ///< such as robot/state
  std::string type;   ///< such as saphira::v1::RobotState
  std::string robot;
};

struct Sample {
  std::uint16_t channel = 0;
  std::int64_t time_ns = 0;  ///< since 1970
  std::string json;          ///< as bus::Echo gives it
};

/// Writes a recording: an MCAP file (https://mcap.dev, version 0) of JSON messages, each channel
/// with a JSON schema. Samples are kept in chunks, compressed with zstd, with an index. A file
/// without its end, as after a kill, has every chunk that was flushed.
class Writer {
 public:
  /// `out`: binary, and empty. It outlives the writer.
  explicit Writer(std::ostream& out);

  /// `schema`: JSON Schema of its samples.
  std::uint16_t add_channel(const Channel& channel, const std::string& schema);
  /// Samples of one channel come in the order of their times.
  void add(const Sample& sample);
  /// Writes the samples since the last flush. False: the stream did not take them.
  bool flush();
  /// Writes the rest and the summary; nothing may be added any more. False: as flush().
  bool close();

  std::uint64_t samples() const { return samples_; }
  std::uint64_t bytes() const { return at_; }

 private:
  struct Kept {
    std::uint64_t samples = 0;
    std::string schema;  ///< the records that describe it, written with its first sample
    std::string channel;
    std::vector<std::pair<std::int64_t, std::uint64_t>> index;  ///< of the chunk: time and place
  };

  void write(std::string_view bytes);

  std::ostream& out_;
  std::uint64_t at_ = 0;
  std::vector<Kept> channels_;
  std::string chunk_;
  std::uint64_t chunk_samples_ = 0;
  std::int64_t chunk_first_ = 0;
  std::int64_t chunk_last_ = 0;
  std::string chunk_indices_;  ///< records for the summary
  std::uint32_t chunks_ = 0;
  std::uint64_t samples_ = 0;
  std::int64_t first_ = 0;
  std::int64_t last_ = 0;
};

/// Reads a recording from its beginning, without its index: also a file that has no end.
class Reader {
 public:
  /// std::invalid_argument: not a recording. `in`: binary; it outlives the reader.
  explicit Reader(std::istream& in);

  /// The next sample in the order of the file; none: the end. std::invalid_argument: a part that is
  /// damaged, compressed otherwise or no JSON, with its place in the file.
  std::optional<Sample> next();
  /// Of a sample that next() has given.
  const Channel& channel(std::uint16_t id) const { return channels_.at(id); }
  /// The file ends amid a record, as after a kill of the recorder.
  bool is_cut_off() const { return cut_off_; }

 private:
  bool read_record();
  void take_record(std::uint8_t code, std::string_view body, std::uint64_t place);

  std::istream& in_;
  std::uint64_t at_ = 0;
  bool ended_ = false;
  bool cut_off_ = false;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<Sample> ready_;
  std::size_t next_ = 0;
};

}  // namespace saphira::recorder
