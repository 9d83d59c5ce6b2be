#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saphira/base/identity.hpp"
#include "saphira/bus/qos.hpp"

namespace saphira::bus {

/// The writer of a sample: its identity on the bus, unique for ever.
using WriterId = std::array<std::uint8_t, 16>;
/// The key of a keyed sample, at most 16 bytes; all zero for a type without key.
using InstanceKey = std::array<std::uint64_t, 2>;

/// By the program's certificate.
using saphira::Identity;

struct SampleInfo {
  WriterId writer{};
  bool disposed = false;  ///< the instance was withdrawn; the data are those that came last
  std::shared_ptr<const Identity> sender = nullptr;  ///< none on an open bus
  /// [s] since it was written, by the clocks of both machines when it was taken.
  double age = 0.0;
};

template <class T>
struct Sample {
  T data;
  SampleInfo info;
};

/// The description of a type for a transport. One object a type, made by type_of<T>().
struct TypeInfo {
  const char* name;  ///< as on the wire, such as saphira::v1::Goal
  bool keyed;
  InstanceKey (*key)(const void* sample);
  void* (*create)();
  void (*copy)(const void* from, void* to);
  void (*destroy)(void* sample);
  /// One JSON object, on one line; `prefix` is put behind its opening brace.
  std::string (*json)(const void* sample, const char* prefix);
  /// Sets the members that the JSON object names. std::invalid_argument gives the place of an
  /// error.
  void (*parse)(const std::string& json, void* sample);
  /// Makes all texts ones for a terminal (base/printable.hpp); line breaks and tabs stay.
  void (*make_printable)(void* sample);
};

/// The types of idl/ alone; defined in src/types.cpp.
template <class T>
const TypeInfo& type_of();

/// A transport's side of a writer.
class RawWriter {
 public:
  virtual ~RawWriter() = default;
  /// False where the sample was not taken within the QoS's blocking time.
  virtual bool write(const void* sample) = 0;
  virtual bool dispose(const void* sample) = 0;
  /// In memory, where nobody checks identities: sets the sender of the following samples.
  virtual void set_sender(const std::shared_ptr<const Identity>& /*sender*/) {}
  virtual bool wait_acknowledged(int timeout_ms) = 0;
  virtual std::size_t matched() const = 0;
};

/// A transport's side of a reader. Samples wait in it until they are taken.
class RawReader {
 public:
  virtual ~RawReader() = default;
  /// Hands over each sample that has come, oldest first. References are valid during the call only.
  /// A lost writer that is heard again: the newest sample of each of its keys comes once more.
  virtual void take(const std::function<void(const void* sample, const SampleInfo&)>& each) = 0;
  /// Writers whose match has ended since the last call, and that are not there again.
  virtual std::vector<WriterId> take_lost() = 0;
  virtual std::size_t matched() const = 0;
};

/// Writes a topic. Thread-compatible; writes are synchronous.
template <class T>
class Writer {
 public:
  explicit Writer(std::unique_ptr<RawWriter> raw) : raw_(std::move(raw)) {}
  bool write(const T& sample) { return raw_->write(&sample); }
  /// Withdraws the instance that has the sample's key.
  bool dispose(const T& sample) { return raw_->dispose(&sample); }
  /// Waits until every matched reliable reader has all written samples; true where they have.
  bool wait_acknowledged(int timeout_ms) { return raw_->wait_acknowledged(timeout_ms); }
  std::size_t matched() const { return raw_->matched(); }
  /// In memory alone: as if the bus had checked that identity.
  void set_sender(const Identity& sender) {
    raw_->set_sender(std::make_shared<const Identity>(sender));
  }

 private:
  std::unique_ptr<RawWriter> raw_;
};

/// Reads a topic. To be used by the thread that waits on the node.
template <class T>
class Reader {
 public:
  explicit Reader(std::unique_ptr<RawReader> raw) : raw_(std::move(raw)) {}

  /// Everything that has come since the last call, oldest first. A writer that take_lost() named,
  /// and that is there again (its program stood still, or was cut off), declares its state once
  /// more: on keyed topics with the newest value of each key, as to a late joiner.
  std::vector<Sample<T>> take() {
    std::vector<Sample<T>> samples;
    raw_->take([&](const void* sample, const SampleInfo& info) {
      samples.push_back({*static_cast<const T*>(sample), info});
    });
    return samples;
  }

  /// As take(), without copies: each(const T&, const SampleInfo&), valid during the call only.
  template <class Each>
  void visit(Each&& each) {
    raw_->take([&](const void* sample, const SampleInfo& info) {
      each(*static_cast<const T*>(sample), info);
    });
  }

  /// The newest live sample that has come since the last call; drops the others.
  std::optional<T> take_newest() {
    std::optional<T> newest;
    raw_->take([&](const void* sample, const SampleInfo& info) {
      if (!info.disposed)
        newest = *static_cast<const T*>(sample);
    });
    return newest;
  }

  /// Writers that are gone since the last call, and have not returned.
  std::vector<WriterId> take_lost() { return raw_->take_lost(); }
  std::size_t matched() const { return raw_->matched(); }

 private:
  std::unique_ptr<RawReader> raw_;
};

}  // namespace saphira::bus
