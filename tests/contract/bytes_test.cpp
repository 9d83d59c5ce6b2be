// The bytes of the contract: they are those of every version before, and of another vendor's code
// from the same files.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_cdrstream.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "cdr.hpp"
#include "json.hpp"
#include "json_reader.hpp"
#include "saphira_cyclone.h"

namespace saphira {
namespace {

using bus::internal::CdrKey;
using bus::internal::from_json;
using bus::internal::kEncapsulationBytes;
using bus::internal::read_cdr;
using bus::internal::to_json;
using bus::internal::write_cdr;

using Bytes = std::vector<char>;

/// Sets each member to a random value.
class Random {
 public:
  template <class T>
  void operator()(const Member& /*member*/, std::vector<T>& values) {
    values.resize(random_() % 4);
    for (T& value : values)
      set(value);
  }
  template <class T>
  void operator()(const Member& /*member*/, T& value) {
    set(value);
  }
  std::uint64_t number() { return random_(); }

 private:
  template <class T>
  void set(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      value = (random_() & 1) != 0;
    } else if constexpr (std::is_same_v<T, std::string>) {
      value.assign(random_() % 12, ' ');
      for (char& letter : value)
        letter = static_cast<char>('a' + random_() % 26);
    } else if constexpr (std::is_enum_v<T>) {
      std::uint32_t count = 0;
      while (name_of(static_cast<T>(count)) != nullptr)
        ++count;
      value = static_cast<T>(random_() % count);
    } else if constexpr (std::is_floating_point_v<T>) {
      value = static_cast<T>(static_cast<std::int64_t>(random_())) / static_cast<T>(1 << 30);
    } else if constexpr (std::is_integral_v<T>) {
      value = static_cast<T>(random_());
    } else {
      visit_members(value, *this);
    }
  }

  std::mt19937_64 random_{42};
};

/// A type's functions, without the type.
struct Type {
  const char* name;
  const dds_topic_descriptor_t* cyclone;
  std::uint64_t hash;  // of the bytes of 200 random samples
  Bytes (*random)(Random& random);
  std::optional<Bytes> (*again)(Bytes bytes);  // read, and written again [none: not read]
  CdrKey (*key)(Bytes bytes);
  std::string (*json)(Bytes bytes);
  Bytes (*of_json)(const std::string& json);
  std::vector<std::string> (*members)();
};

template <class T>
Bytes written(const T& sample) {
  Bytes bytes(bus::internal::cdr_size(sample));
  EXPECT_EQ(write_cdr(sample, bytes.data(), bytes.size()), bytes.size());
  return bytes;
}

template <class T>
T read(Bytes bytes) {
  T sample;
  read_cdr(bytes.data(), bytes.size(), sample);
  return sample;
}

template <class T>
Type type(const char* name, const dds_topic_descriptor_t& cyclone, std::uint64_t hash) {
  return {.name = name,
          .cyclone = &cyclone,
          .hash = hash,
          .random =
              [](Random& random) {
                T sample;
                visit_members(sample, random);
                const Bytes bytes = written(sample);
                EXPECT_EQ(read<T>(bytes), sample);
                return bytes;
              },
          .again = [](Bytes bytes) -> std::optional<Bytes> {
            try {
              return written(read<T>(std::move(bytes)));
            } catch (const std::exception&) {
              return std::nullopt;
            }
          },
          .key = [](Bytes bytes) { return CdrKey(read<T>(std::move(bytes))); },
          .json = [](Bytes bytes) { return to_json(read<T>(std::move(bytes)), ""); },
          .of_json =
              [](const std::string& json) {
                T sample;
                from_json(json, sample);
                return written(sample);
              },
          .members =
              [] {
                std::vector<std::string> names;
                const T sample;
                visit_members(sample, [&](const Member& member, const auto& /*value*/) {
                  names.emplace_back(member.name);
                });
                return names;
              }};
}

// The hashes are of the bytes that the contract has had from the beginning, by another generator. A
// changed type is a new version of it.
std::vector<Type> types() {
#define TYPE(T, hash) type<v1::T>(#T, saphira_v1_##T##_desc, hash)
  return {
      TYPE(Request, 0xca3f3073e6a5b0af),
      TYPE(Answer, 0x2d4b1d9d5b531b89),
      TYPE(RobotState, 0x2cb327b289d748dd),
      TYPE(RobotDescription, 0x142f951cb6773f67),
      TYPE(SonarBuckets, 0xd6b9fd3d90747faf),
      TYPE(Devices, 0xe7f554ffbed4aa4b),
      TYPE(SerialData, 0x47b2a6618cd8040d),
      TYPE(MotorCommand, 0x58fb3bb176a95565),
      TYPE(Grant, 0x4bda4f4b5b3e4d4d),
      TYPE(StepPermit, 0x8d1b475a7ec1a87b),
      TYPE(Perception, 0x6f30e70d5e49813f),
      TYPE(GridTile, 0x37f3afaa0a88acdf),
      TYPE(VisionChannels, 0xc5437e84fabd7eeb),
      TYPE(Vision, 0x321632bde399b2f8),
      TYPE(FloorMap, 0x26973aadd68a2f8f),
      TYPE(Registration, 0x57b8253a9ba6293d),
      TYPE(BehaviorSet, 0x08ff02971f696d26),
      TYPE(Intentions, 0xf45b7312f344a20f),
      TYPE(Goal, 0x5857111e1c09b4ad),
      TYPE(GoalStatus, 0xe8c7678efc09a706),
      TYPE(GoalStatusSet, 0xccdaf3db872e44a7),
      TYPE(BehaviorSchemas, 0x32697a16266de647),
      TYPE(ActivitySchemas, 0x0f56e122bfdf9e23),
      TYPE(BeliefSet, 0x64ae48456655e4cd),
      TYPE(BeliefClaim, 0x2a3e52dfb40d5a22),
      TYPE(Agent, 0x268881e626890c5b),
      TYPE(AgentEvent, 0xb50e10867c501a65),
      TYPE(Trigger, 0x9458268e38d10e10),
      TYPE(Utterance, 0xa41d19303b4a0324),
      TYPE(Knowledge, 0x318938dc5aab7604),
      TYPE(ProgramMind, 0x4f60d3218e99aeeb),
      TYPE(ProcessSet, 0x5d398f03e1e919cd),
      TYPE(Message, 0x4340e8fba65d2a7c),
      TYPE(Drawing, 0x76509969ff0c9b1d),
      TYPE(ServiceStatus, 0xe17c5e96aa3e81c2),
      TYPE(Presence, 0x1460556a0fb51e13),
      TYPE(LogRecord, 0xc1dbf47e69a09277),
      TYPE(AuditEntry, 0xbfa1fa7286179647),
  };
#undef TYPE
}

/// The type as another vendor's code (Cyclone DDS) from the same files has it.
class Cyclone {
 public:
  explicit Cyclone(const Type& type) : ops_(type.cyclone->m_ops), size_(type.cyclone->m_size) {
    for (std::uint32_t i = 0; i < type.cyclone->m_nkeys; ++i)
      keys_.push_back({type.cyclone->m_keys[i].m_offset, type.cyclone->m_keys[i].m_idx});
    type_.type.size = size_;
    type_.type.align = type.cyclone->m_align;
    type_.type.flagset = type.cyclone->m_flagset;
    type_.type.keys = {static_cast<std::uint32_t>(keys_.size()), keys_.data()};
    type_.type.ops = {type.cyclone->m_nops, const_cast<std::uint32_t*>(ops_)};
    type_.write_encoding_version = version;
  }

  struct Read {
    Bytes again;  // written
    Bytes key;
  };
  /// `look` gets the sample. None: it is no such sample.
  template <class Look>
  std::optional<Read> read(const Bytes& bytes, Look&& look) const {
    // Whole words, as they come from the network.
    const std::size_t size = bytes.size() - kEncapsulationBytes;
    std::vector<std::uint64_t> words(size / 8 + 1);
    std::memcpy(words.data(), bytes.data() + kEncapsulationBytes, size);
    std::uint32_t actual = 0;
    if (!dds_stream_normalize(words.data(), static_cast<std::uint32_t>(size), false, version,
                              &type_, false, &actual))
      return std::nullopt;
    std::vector<std::uint64_t> sample(size_ / 8 + 1);
    dds_istream_t in{};
    dds_istream_init(&in, static_cast<std::uint32_t>(size), words.data(), version);
    dds_stream_read_sample(&in, sample.data(), &type_);
    look(sample.data());
    dds_ostreamLE_t out{};
    dds_ostreamLE_init(&out, 0, version);
    EXPECT_TRUE(dds_stream_write_sampleLE(&out, sample.data(), &type_));
    Read result{{0, 1, 0, 0}, {}};
    result.again.insert(result.again.end(), out.x.m_buffer, out.x.m_buffer + out.x.m_index);
    dds_ostreamLE_fini(&out);
    if (!keys_.empty()) {
      dds_ostreamBE_t key{};
      dds_ostreamBE_init(&key, 0, version);
      dds_stream_write_keyBE(&key, reinterpret_cast<const char*>(sample.data()), &type_);
      result.key.assign(key.x.m_buffer, key.x.m_buffer + key.x.m_index);
      dds_ostreamBE_fini(&key);
    }
    dds_stream_free_sample(sample.data(), ops_);
    return result;
  }
  std::optional<Read> read(const Bytes& bytes) const {
    return read(bytes, [](const void* /*sample*/) {});
  }

 private:
  static constexpr std::uint32_t version = 1;  // XCDR

  const std::uint32_t* ops_;
  std::uint32_t size_;
  std::vector<ddsi_sertype_default_desc_key_t> keys_;
  ddsi_sertype_default type_{};
};

TEST(ContractBytes, AreThoseOfEveryVersionBefore) {
  for (const Type& type : types()) {
    Random random;
    std::uint64_t hash = 0xcbf29ce484222325;
    for (int i = 0; i < 200; ++i)
      for (const char byte : type.random(random))
        hash = (hash ^ static_cast<std::uint8_t>(byte)) * 0x100000001b3;
    EXPECT_EQ(hash, type.hash) << type.name << " 0x" << std::hex << hash;
  }
}

TEST(ContractBytes, AreThoseOfAnotherVendor) {
  for (const Type& type : types()) {
    const Cyclone cyclone(type);
    Random random;
    for (int i = 0; i < 200; ++i) {
      const Bytes bytes = type.random(random);
      const auto read = cyclone.read(bytes);
      ASSERT_TRUE(read) << type.name;
      EXPECT_EQ(read->again, bytes) << type.name;
      EXPECT_EQ(type.again(read->again), bytes) << type.name;
      const CdrKey key = type.key(bytes);
      EXPECT_EQ(read->key,
                Bytes(key.bytes.begin(), key.bytes.begin() + static_cast<long>(key.size)))
          << type.name;
    }
  }
}

TEST(ContractBytes, HaveTheMembersOfAnotherVendor) {
  v1::Goal goal{.id = {.writer = 1, .number = 2}, .requester = "somebody", .functor = "go_to"};
  goal.arguments.push_back({.name = "place", .kind = v1::ARGUMENT_TEXT, .text = "room EJ-231"});
  goal.priority = -3;
  goal.deadline = 4.5;
  goal.writer_lost = v1::WRITER_LOST_KEEP;
  goal.level = 0.5;
  goal.withdrawn = "no longer";
  const Cyclone cyclone(type<v1::Goal>("Goal", saphira_v1_Goal_desc, 0));
  EXPECT_TRUE(cyclone.read(written(goal), [](const void* sample) {
    const auto& read = *static_cast<const saphira_v1_Goal*>(sample);
    EXPECT_EQ(read.id.writer, 1U);
    EXPECT_EQ(read.id.number, 2U);
    EXPECT_STREQ(read.requester, "somebody");
    EXPECT_STREQ(read.functor, "go_to");
    ASSERT_EQ(read.arguments._length, 1U);
    EXPECT_STREQ(read.arguments._buffer[0].name, "place");
    EXPECT_EQ(read.arguments._buffer[0].kind, saphira_v1_ARGUMENT_TEXT);
    EXPECT_STREQ(read.arguments._buffer[0].text, "room EJ-231");
    EXPECT_EQ(read.priority, -3);
    EXPECT_EQ(read.deadline, 4.5);
    EXPECT_EQ(read.writer_lost, saphira_v1_WRITER_LOST_KEEP);
    EXPECT_EQ(read.level, 0.5);
    EXPECT_STREQ(read.withdrawn, "no longer");
  }));
}

TEST(HostileBytes, ThatEndTooEarlyAreNoSample) {
  for (const Type& type : types()) {
    Random random;
    const Bytes bytes = type.random(random);
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_EQ(type.again(Bytes(bytes.begin(), bytes.begin() + static_cast<long>(size))),
                std::nullopt)
          << type.name << " " << size;
  }
}

// A sample that another vendor reads is read, with the same values.
TEST(HostileBytes, WithAnyValueAreReadAsByAnotherVendor) {
  int read = 0;
  int refused = 0;
  for (const Type& type : types()) {
    const Cyclone cyclone(type);
    Random random;
    for (int i = 0; i < 2000; ++i) {
      Bytes bytes = type.random(random);
      const std::size_t at =
          kEncapsulationBytes + random.number() % (bytes.size() - kEncapsulationBytes);
      bytes[at] = static_cast<char>(random.number());
      const auto by_them = cyclone.read(bytes);
      const auto by_us = type.again(bytes);
      if (by_them) {
        EXPECT_EQ(by_us, by_them->again) << type.name << " " << at;
        ++read;
      } else {
        ++refused;
      }
    }
  }
  EXPECT_GT(read, 10000);
  EXPECT_GT(refused, 1000);
}

TEST(HostileBytes, OverABoundAreNoSample) {
  v1::SerialData data;
  data.data.resize(200);
  Bytes bytes = written(data);
  EXPECT_EQ(read<v1::SerialData>(bytes).data.size(), 200U);
  data.data.resize(201);
  EXPECT_THROW(written(data), std::length_error);
  // As somebody else may write it.
  bytes.push_back(0);
  for (std::size_t i = kEncapsulationBytes; i + 4 < bytes.size(); ++i)
    if (static_cast<std::uint8_t>(bytes[i]) == 200 && bytes[i + 1] == 0)
      bytes[i] = static_cast<char>(201);
  EXPECT_THROW(read<v1::SerialData>(bytes), std::length_error);
}

TEST(HostileBytes, OfAnEndlessSequenceTakeNoMemory) {
  Bytes bytes = written(v1::GoalStatusSet{});
  std::fill(bytes.end() - 4, bytes.end(), '\xff');
  EXPECT_THROW(read<v1::GoalStatusSet>(bytes), std::length_error);
}

TEST(HostileBytes, OfAnUnknownEnumeratorKeepItsNumber) {
  v1::Goal goal{.writer_lost = static_cast<v1::WriterLost>(77)};
  const auto again = read<v1::Goal>(written(goal));
  EXPECT_EQ(again.writer_lost, 77U);
  EXPECT_EQ(name_of(again.writer_lost), nullptr);
  EXPECT_EQ(nlohmann::json::parse(to_json(again, ""))["writer_lost"], 77);
}

TEST(HostileBytes, OfATruthThatIsNoneAreNoSample) {
  v1::MotorCommand command;
  Bytes bytes = written(command);
  command.active = true;
  const Bytes other = written(command);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    if (bytes[i] != other[i])
      bytes[i] = 2;
  EXPECT_ANY_THROW(read<v1::MotorCommand>(bytes));
}

TEST(ContractJson, IsReadToTheSameSample) {
  for (const Type& type : types()) {
    Random random;
    for (int i = 0; i < 50; ++i) {
      const Bytes bytes = type.random(random);
      EXPECT_EQ(type.of_json(type.json(bytes)), bytes) << type.name;
    }
  }
}

TEST(ContractSchema, HasTheMembersOfEachType) {
  std::ifstream file(SAPHIRA_SCHEMA);
  const auto schema = nlohmann::ordered_json::parse(file);
  for (const Type& type : types()) {
    std::vector<std::string> names;
    for (const auto& [name, member] : schema["$defs"][type.name]["properties"].items())
      names.push_back(name);
    EXPECT_EQ(names, type.members()) << type.name;
  }
  EXPECT_EQ(schema["$defs"]["Goal"]["properties"]["arguments"]["maxItems"], 16);
  EXPECT_EQ(schema["$defs"]["Goal"]["properties"]["writer_lost"]["$ref"], "#/$defs/WriterLost");
  EXPECT_EQ(schema["$defs"]["WriterLost"]["enum"].size(), 2U);
}

}  // namespace
}  // namespace saphira
