#include "saphira/recorder/recording.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <stdexcept>

#include "saphira/base/text.hpp"

namespace saphira::recorder {

namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::uint64_t kLongest = std::uint64_t{64} << 20U;  // [bytes] of a record
constexpr std::size_t kPiece = std::size_t{1} << 20U;         // [bytes] that are read at once
constexpr const char* kRobot = "robot";                       // a channel's metadata

// Records of the format, by their codes.
constexpr std::uint8_t kHeader = 1;
constexpr std::uint8_t kFooter = 2;
constexpr std::uint8_t kSchema = 3;
constexpr std::uint8_t kChannel = 4;
constexpr std::uint8_t kMessage = 5;
constexpr std::uint8_t kChunk = 6;
constexpr std::uint8_t kMessageIndex = 7;
constexpr std::uint8_t kChunkIndex = 8;
constexpr std::uint8_t kStatistics = 11;
constexpr std::uint8_t kSummaryOffset = 14;
constexpr std::uint8_t kDataEnd = 15;

// Numbers are little-endian.
template <std::integral T>
void put(std::string& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    out += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFFU);
}

void put(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

template <class... Fields>
std::string fields(const Fields&... values) {
  std::string out;
  (put(out, values), ...);
  return out;
}

std::string record(std::uint8_t code, std::string_view body) {
  return fields(code, std::uint64_t{body.size()}).append(body);
}

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(crc32(0, nullptr, 0), reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

constexpr std::string_view kZstd = "zstd";

std::string compressed(std::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  // The library fails only for want of space.
  out.resize(
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), ZSTD_CLEVEL_DEFAULT));
  return out;
}

/// The fields of a record, one after the other.
class Fields {
 public:
  Fields(std::string_view bytes, std::uint64_t place) : bytes_(bytes), place_(place) {}

  template <class T>
  T number() {
    std::uint64_t value = 0;
    const std::string_view taken = take(sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i)
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(taken[i])) << (8 * i);
    return static_cast<T>(value);
  }
  std::string_view text() { return take(number<std::uint32_t>()); }
  std::string_view take(std::uint64_t count) {
    if (count > bytes_.size())
      complain("a record ends amid a field");
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  std::string_view rest() { return take(bytes_.size()); }
  bool empty() const { return bytes_.empty(); }
  [[noreturn]] void complain(const std::string& what) const {
    throw std::invalid_argument("byte " + std::to_string(place_) + ": " + what);
  }

 private:
  std::string_view bytes_;
  std::uint64_t place_;
};

/// The `size` bytes that a chunk says it has.
std::string decompressed(std::string_view packed, std::uint64_t size, const Fields& chunk) {
  if (size > kLongest)
    chunk.complain("a part of " + std::to_string(size) + " bytes");
  std::string out(size, '\0');
  const std::size_t made = ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size());
  if (ZSTD_isError(made) != 0 || made != size)
    chunk.complain("damaged: this part cannot be decompressed");
  return out;
}

}  // namespace

Writer::Writer(std::ostream& out) : out_(out) {
  write(std::string(kMagic) + record(kHeader, fields("", "saphira")));
}

std::uint16_t Writer::add_channel(const Channel& channel, const std::string& schema) {
  const auto number = static_cast<std::uint16_t>(channels_.size());
  const auto id = static_cast<std::uint16_t>(number + 1);  // 0 is no schema
  const std::string metadata = fields(kRobot, channel.robot);
  channels_.push_back({0,
                       record(kSchema, fields(id, channel.type, "jsonschema", schema)),
                       record(kChannel, fields(number, id, channel.topic, "json", metadata)),
                       {}});
  return number;
}

void Writer::add(const Sample& sample) {
  Kept& kept = channels_.at(sample.channel);
  if (kept.samples == 0)
    chunk_ += kept.schema + kept.channel;
  chunk_first_ = chunk_samples_ == 0 ? sample.time_ns : std::min(chunk_first_, sample.time_ns);
  chunk_last_ = chunk_samples_ == 0 ? sample.time_ns : std::max(chunk_last_, sample.time_ns);
  ++chunk_samples_;
  first_ = samples_ == 0 ? sample.time_ns : std::min(first_, sample.time_ns);
  last_ = samples_ == 0 ? sample.time_ns : std::max(last_, sample.time_ns);
  kept.index.emplace_back(sample.time_ns, chunk_.size());
  chunk_ += record(kMessage, fields(sample.channel, static_cast<std::uint32_t>(kept.samples),
                                    sample.time_ns, sample.time_ns) +
                                 sample.json);
  ++kept.samples;
  ++samples_;
}

bool Writer::flush() {
  if (chunk_.empty())
    return static_cast<bool>(out_);
  const std::string packed = compressed(chunk_);
  const std::uint64_t size = chunk_.size();
  const std::uint64_t packed_size = packed.size();
  const std::string chunk =
      record(kChunk, fields(chunk_first_, chunk_last_, size, checksum(chunk_), kZstd, packed_size) +
                         packed);
  const std::uint64_t chunk_at = at_;
  std::string indices;
  std::string places;
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    Kept& kept = channels_[id];
    if (kept.index.empty())
      continue;
    const auto number = static_cast<std::uint16_t>(id);
    places += fields(number, chunk_at + chunk.size() + indices.size());
    std::string entries;
    for (const auto& [time, place] : kept.index)
      entries += fields(time, place);
    indices += record(kMessageIndex, fields(number, entries));
    kept.index.clear();
  }
  chunk_indices_ +=
      record(kChunkIndex, fields(chunk_first_, chunk_last_, chunk_at, std::uint64_t{chunk.size()},
                                 places, std::uint64_t{indices.size()}, kZstd, packed_size, size));
  ++chunks_;
  chunk_samples_ = 0;
  chunk_.clear();
  write(chunk + indices);
  return static_cast<bool>(out_.flush());
}

bool Writer::close() {
  flush();
  constexpr std::uint32_t none = 0;
  write(record(kDataEnd, fields(none)));  // no checksum of the whole
  const std::uint64_t summary = at_;
  std::string offsets;
  const auto group = [&](std::uint8_t code, const std::string& records) {
    if (records.empty())
      return;
    offsets += record(kSummaryOffset, fields(code, at_, std::uint64_t{records.size()}));
    write(records);
  };
  std::string schemas;
  std::string channels;
  std::string counts;
  std::uint32_t described = 0;
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    const Kept& kept = channels_[id];
    if (kept.samples == 0)
      continue;
    ++described;
    schemas += kept.schema;
    channels += kept.channel;
    counts += fields(static_cast<std::uint16_t>(id), kept.samples);
  }
  group(kSchema, schemas);
  group(kChannel, channels);
  // No attachments, and no metadata.
  group(kStatistics,
        record(kStatistics, fields(samples_, static_cast<std::uint16_t>(described), described, none,
                                   none, chunks_, first_, last_, counts)));
  group(kChunkIndex, chunk_indices_);
  const std::string footer = fields(summary, at_, none);
  write(offsets + record(kFooter, footer) + std::string(kMagic));
  return static_cast<bool>(out_.flush());
}

void Writer::write(std::string_view bytes) {
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  at_ += bytes.size();
}

Reader::Reader(std::istream& in) : in_(in) {
  std::string magic(kMagic.size(), '\0');
  in_.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  if (magic != kMagic) {
    std::string more(kMagic.size(), '\0');
    in_.read(more.data(), static_cast<std::streamsize>(more.size()));
    const std::string_view other = magic.starts_with("\x89MCAP") ? "" : other_format(magic + more);
    throw std::invalid_argument("not an MCAP file: " + (other.empty()
                                                            ? "its first bytes are others"
                                                            : "this is " + std::string(other)));
  }
  at_ = kMagic.size();
}

std::optional<Sample> Reader::next() {
  while (next_ == ready_.size()) {
    ready_.clear();
    next_ = 0;
    if (!read_record())
      return std::nullopt;
  }
  return std::move(ready_[next_++]);
}

bool Reader::read_record() {
  if (ended_)
    return false;
  std::array<char, 9> head{};
  in_.read(head.data(), head.size());
  if (in_.gcount() < static_cast<std::streamsize>(head.size())) {
    ended_ = cut_off_ = true;
    return false;
  }
  Fields fields({head.data(), head.size()}, at_);
  const auto code = fields.number<std::uint8_t>();
  const auto length = fields.number<std::uint64_t>();
  if (length > kLongest)
    fields.complain("a record of " + std::to_string(length) + " bytes");
  std::string body;
  while (body.size() < length) {  // in pieces: the length may be wrong
    const std::size_t had = body.size();
    body.resize(std::min<std::size_t>(length, had + kPiece));
    in_.read(body.data() + had, static_cast<std::streamsize>(body.size() - had));
    if (static_cast<std::size_t>(in_.gcount()) < body.size() - had) {
      ended_ = cut_off_ = true;
      return false;
    }
  }
  const std::uint64_t place = at_;
  at_ += head.size() + length;
  if (code == kDataEnd || code == kFooter)
    ended_ = true;
  take_record(code, body, place);
  return true;
}

void Reader::take_record(std::uint8_t code, std::string_view body, std::uint64_t place) {
  Fields fields(body, place);
  if (code == kChunk) {
    fields.take(2 * sizeof(std::uint64_t));
    const auto size = fields.number<std::uint64_t>();
    const auto crc = fields.number<std::uint32_t>();
    const std::string_view compression = fields.text();
    std::string_view records = fields.take(fields.number<std::uint64_t>());
    std::string unpacked;
    if (compression == kZstd) {
      unpacked = decompressed(records, size, fields);
      records = unpacked;
    } else if (!compression.empty()) {
      fields.complain("compressed with " + std::string(compression.substr(0, 20)) +
                      "; `mcap compress --compression zstd` makes a file that can be read");
    }
    if (crc != 0 && crc != checksum(records))
      fields.complain("damaged: the checksum of this part is another");
    for (Fields inside(records, place); !inside.empty();) {
      const auto kind = inside.number<std::uint8_t>();
      if (kind == kChunk)
        fields.complain("a chunk within a chunk");
      take_record(kind, inside.take(inside.number<std::uint64_t>()), place);
    }
  } else if (code == kSchema) {
    const auto id = fields.number<std::uint16_t>();
    schemas_[id] = fields.text();
  } else if (code == kChannel) {
    const auto id = fields.number<std::uint16_t>();
    Channel channel;
    channel.type = schemas_[fields.number<std::uint16_t>()];
    channel.topic = fields.text();
    if (fields.text() != "json")
      fields.complain("the samples of " + channel.topic + " are not in JSON");
    for (Fields metadata(fields.text(), place); !metadata.empty();) {
      const std::string_view name = metadata.text();
      const std::string_view value = metadata.text();
      if (name == kRobot)
        channel.robot = value;
    }
    channels_[id] = std::move(channel);
  } else if (code == kMessage) {
    Sample sample;
    sample.channel = fields.number<std::uint16_t>();
    fields.number<std::uint32_t>();
    sample.time_ns = fields.number<std::int64_t>();
    fields.number<std::uint64_t>();
    sample.json = fields.rest();
    if (!channels_.contains(sample.channel))
      fields.complain("a sample of an unknown channel");
    ready_.push_back(std::move(sample));
  }
}

}  // namespace saphira::recorder
