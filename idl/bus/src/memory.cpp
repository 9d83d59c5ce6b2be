// The bus within a process, for tests: the same rules of matching, latching, withdrawing and losing
// as over DDS, delivered at once and in order.

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <mutex>
#include <utility>

#include "internal.hpp"
#include "saphira/base/format.hpp"

namespace saphira::bus {
namespace internal {
namespace {

class MemoryWriter;
class MemoryReader;

}  // namespace
}  // namespace internal

class MemoryBus {
 public:
  std::mutex mutex;
  std::uint64_t nodes_made = 0;
  std::uint32_t endpoints_made = 0;
  std::vector<internal::MemoryWriter*> writers;
  std::vector<internal::MemoryReader*> readers;
};

std::shared_ptr<MemoryBus> make_memory_bus() {
  return std::make_shared<MemoryBus>();
}

namespace internal {
namespace {

struct Item {
  std::shared_ptr<const void> data;
  InstanceKey key;
  WriterId writer;
  bool disposed;
  std::shared_ptr<const Identity> sender;
  std::chrono::steady_clock::time_point written;
};

// KEEP_LAST: of each key the newest `depth`. An item of that key was just added.
void keep_last(std::deque<Item>& items, const InstanceKey& key, bool keyed, int depth) {
  if (static_cast<int>(items.size()) <= depth)
    return;
  if (!keyed)
    return items.pop_front();
  auto oldest = items.end();
  int older = 0;
  for (auto item = items.begin(); item + 1 != items.end(); ++item) {
    if (item->key != key)
      continue;
    if (older == 0)
      oldest = item;
    if (++older == depth) {
      items.erase(oldest);
      return;
    }
  }
}

// The members that readers and writers have in common, with those of their node.
struct Common {
  std::shared_ptr<MemoryBus> bus;
  std::shared_ptr<Wake> wake;
  std::shared_ptr<std::vector<std::string>> troubles;  // of the node, guarded by the bus's mutex
  EndpointEntry entry;
  Policies policies;
  const TypeInfo* type;
  std::uint64_t node;
  bool silent = false;
};

// As over DDS the first 12 bytes are the node's.
WriterId next_id(const Common& common) {
  WriterId id{};
  for (unsigned i = 0; i < 8; ++i)
    id[i] = static_cast<std::uint8_t>(common.node >> (8U * i));
  const std::uint32_t number = ++common.bus->endpoints_made;
  for (unsigned i = 0; i < 4; ++i)
    id[12 + i] = static_cast<std::uint8_t>(number >> (8U * i));
  return id;
}

class MemoryWriter : public RawWriter {
 public:
  explicit MemoryWriter(Common common);
  ~MemoryWriter() override;
  MemoryWriter& operator=(MemoryWriter&&) = delete;

  void set_sender(const std::shared_ptr<const Identity>& of) override { sender = of; }
  bool write(const void* sample) override { return put(sample, false); }
  bool dispose(const void* sample) override { return put(sample, true); }
  bool wait_acknowledged(int /*timeout_ms*/) override { return true; }
  std::size_t matched() const override;

  Common common;
  WriterId id{};
  std::shared_ptr<const Identity> sender;
  std::vector<MemoryReader*> matches;
  std::deque<Item> history;

 private:
  bool put(const void* sample, bool disposed);

  // The newest samples, of topics without keys. Their memory is used again when nobody has them.
  std::vector<std::shared_ptr<void>> newest_;
  std::size_t next_ = 0;
};

class MemoryReader : public RawReader {
 public:
  explicit MemoryReader(Common common);
  ~MemoryReader() override;
  MemoryReader& operator=(MemoryReader&&) = delete;

  void take(const std::function<void(const void*, const SampleInfo&)>& each) override;
  std::vector<WriterId> take_lost() override;
  std::size_t matched() const override;

  void deliver(const Item& item) {
    queue.push_back(item);
    keep_last(queue, item.key, common.type->keyed, common.policies.reader_depth);
    common.wake->signal();
  }

  Common common;
  std::vector<MemoryWriter*> matches;
  std::deque<Item> queue;
  std::vector<WriterId> lost;
  std::vector<WriterId> returned;

 private:
  std::deque<Item> taken_;            // while they are handed over; empty, with its memory
  std::map<InstanceKey, Item> last_;  // taken, and not withdrawn since
};

template <class Matches>
std::size_t heard(const Matches& matches) {
  return static_cast<std::size_t>(std::count_if(
      matches.begin(), matches.end(), [](const auto* other) { return !other->common.silent; }));
}

// With the bus's mutex.
void match(MemoryWriter& writer, MemoryReader& reader) {
  const auto& offered = writer.common.entry;
  const auto& requested = reader.common.entry;
  if (offered.topic != requested.topic || !partitions_meet(offered.robot, requested.robot))
    return;
  if (const auto text = mismatch_text(offered, requested, requested.program)) {
    writer.common.troubles->push_back(*text);
    reader.common.troubles->push_back(*mismatch_text(requested, offered, offered.program));
  } else {
    writer.matches.push_back(&reader);
    reader.matches.push_back(&writer);
    if (reader.common.policies.transient_local)
      for (const auto& item : writer.history)
        reader.deliver(item);
  }
  writer.common.wake->signal();
  reader.common.wake->signal();
}

MemoryWriter::MemoryWriter(Common the_common) : common(std::move(the_common)) {
  const std::scoped_lock lock(common.bus->mutex);
  id = next_id(common);
  common.entry.id = hex_text(id);
  // As many as lie in the history and in a reader, and the next one.
  newest_.resize(common.type->keyed ? 1
                                    : static_cast<std::size_t>(common.policies.writer_depth) + 2);
  common.bus->writers.push_back(this);
  for (auto* reader : common.bus->readers)
    match(*this, *reader);
}

MemoryWriter::~MemoryWriter() {
  const std::scoped_lock lock(common.bus->mutex);
  std::erase(common.bus->writers, this);
  for (auto* reader : matches) {
    std::erase(reader->matches, this);
    if (!common.silent)
      reader->lost.push_back(id);
    reader->common.wake->signal();
  }
}

bool MemoryWriter::put(const void* sample, bool disposed) {
  std::unique_lock lock(common.bus->mutex);
  // Most topics have no reader within the process.
  if (!disposed && !common.policies.transient_local && heard(matches) == 0)
    return true;
  next_ = (next_ + 1) % newest_.size();
  std::shared_ptr<void> copy = newest_[next_];
  if (copy.use_count() != 2)
    copy.reset(common.type->create(), common.type->destroy);
  if (!common.type->keyed)
    newest_[next_] = copy;
  lock.unlock();
  common.type->copy(sample, copy.get());
  const Item item{std::move(copy),
                  common.type->keyed ? common.type->key(sample) : InstanceKey{},
                  id,
                  disposed,
                  sender,
                  std::chrono::steady_clock::now()};
  lock.lock();
  if (disposed) {
    std::erase_if(history, [&](const Item& old) { return old.key == item.key; });
  } else if (common.policies.transient_local) {
    history.push_back(item);
    keep_last(history, item.key, common.type->keyed, common.policies.writer_depth);
  }
  for (auto* reader : matches)
    reader->deliver(item);
  return true;
}

std::size_t MemoryWriter::matched() const {
  const std::scoped_lock lock(common.bus->mutex);
  return heard(matches);
}

MemoryReader::MemoryReader(Common the_common) : common(std::move(the_common)) {
  const std::scoped_lock lock(common.bus->mutex);
  common.entry.id = hex_text(next_id(common));
  common.bus->readers.push_back(this);
  for (auto* writer : common.bus->writers)
    match(*writer, *this);
}

MemoryReader::~MemoryReader() {
  const std::scoped_lock lock(common.bus->mutex);
  std::erase(common.bus->readers, this);
  for (auto* writer : matches) {
    std::erase(writer->matches, this);
    writer->common.wake->signal();
  }
}

void MemoryReader::take(const std::function<void(const void*, const SampleInfo&)>& each) {
  std::unique_lock lock(common.bus->mutex);
  if (queue.empty() && returned.empty())
    return;
  taken_.clear();  // where the last call threw
  taken_.swap(queue);
  const std::vector<WriterId> back = std::exchange(returned, {});
  lock.unlock();
  const auto now = std::chrono::steady_clock::now();
  const auto info_of = [now](const Item& item) {
    return SampleInfo{item.writer, item.disposed, item.sender,
                      std::chrono::duration<double>(now - item.written).count()};
  };
  if (common.policies.declares())
    for (const auto& [key, item] : last_)
      if (std::find(back.begin(), back.end(), item.writer) != back.end())
        taken_.push_front(item);
  for (const auto& item : taken_) {
    if (!item.disposed) {
      if (common.type->keyed)
        last_.insert_or_assign(item.key, item);
      each(item.data.get(), info_of(item));
    } else if (const auto found = last_.find(item.key); found != last_.end()) {
      const auto data = std::move(found->second.data);
      last_.erase(found);
      each(data.get(), info_of(item));
    }
  }
  lock.lock();  // for the writers, which use the memory again
  taken_.clear();
}

std::vector<WriterId> MemoryReader::take_lost() {
  const std::scoped_lock lock(common.bus->mutex);
  return std::exchange(lost, {});
}

std::size_t MemoryReader::matched() const {
  const std::scoped_lock lock(common.bus->mutex);
  return heard(matches);
}

class MemoryTransport : public Transport {
 public:
  MemoryTransport(const NodeOptions& options, std::shared_ptr<MemoryBus> bus,
                  std::shared_ptr<Wake> wake)
      : options_(options), bus_(std::move(bus)), wake_(std::move(wake)) {
    const std::scoped_lock lock(bus_->mutex);
    node_ = ++bus_->nodes_made;
  }

  std::unique_ptr<RawWriter> make_writer(const char* topic, const Policies& policies,
                                         const TypeInfo& type) override {
    return std::make_unique<MemoryWriter>(common(topic, policies, type, true));
  }
  std::unique_ptr<RawReader> make_reader(const char* topic, const Policies& policies,
                                         const TypeInfo& type) override {
    return std::make_unique<MemoryReader>(common(topic, policies, type, false));
  }

  std::vector<EndpointEntry> endpoints() const override {
    const std::scoped_lock lock(bus_->mutex);
    std::vector<EndpointEntry> result;
    for (const auto* writer : bus_->writers)
      if (writer->common.wake != wake_)
        result.push_back(writer->common.entry);
    for (const auto* reader : bus_->readers)
      if (reader->common.wake != wake_)
        result.push_back(reader->common.entry);
    return result;
  }
  std::vector<std::string> take_troubles() override {
    const std::scoped_lock lock(bus_->mutex);
    return std::exchange(*troubles_, {});
  }
  void watch_endpoints(bool /*watch*/) override {}
  bool is_own(const WriterId& writer) const override {
    std::uint64_t node = 0;
    for (unsigned i = 0; i < 8; ++i)
      node |= static_cast<std::uint64_t>(writer[i]) << (8U * i);
    return node == node_;
  }

 private:
  Common common(const char* topic, const Policies& policies, const TypeInfo& type,
                bool writer) const {
    if (options_.dry_run)
      check_role(options_, topic, writer);
    EndpointEntry entry;
    entry.topic = topic;
    entry.type = type.name;
    entry.writer = writer;
    entry.program = options_.name;
    entry.host = host_name();
    entry.pid = static_cast<std::uint32_t>(getpid());
    entry.robot = options_.robot;
    entry.reliable = policies.reliable;
    entry.durability = policies.transient_local ? "transient_local" : "volatile";
    entry.liveliness = "automatic";
    entry.ownership = "shared";
    return {bus_, wake_, troubles_, entry, policies, &type, node_};
  }

  NodeOptions options_;
  std::shared_ptr<MemoryBus> bus_;
  std::shared_ptr<Wake> wake_;
  std::uint64_t node_ = 0;
  std::shared_ptr<std::vector<std::string>> troubles_ =
      std::make_shared<std::vector<std::string>>();
};

}  // namespace

std::unique_ptr<Transport> make_memory_transport(const NodeOptions& options,
                                                 std::shared_ptr<MemoryBus> bus,
                                                 std::shared_ptr<Wake> wake) {
  return std::make_unique<MemoryTransport>(options, std::move(bus), std::move(wake));
}

}  // namespace internal

void set_silent(MemoryBus& bus, const std::string& program, bool silent) {
  const std::scoped_lock lock(bus.mutex);
  const auto change = [&](auto& endpoints, auto tell) {
    for (auto* const one : endpoints)
      if (one->common.entry.program == program && one->common.silent != silent) {
        one->common.silent = silent;
        for (auto* const other : one->matches) {
          tell(*one, *other);
          other->common.wake->signal();
        }
      }
  };
  change(bus.writers, [&](const internal::MemoryWriter& writer, internal::MemoryReader& reader) {
    if (silent) {
      std::erase(reader.returned, writer.id);
      reader.lost.push_back(writer.id);
    } else if (std::erase(reader.lost, writer.id) == 0) {
      reader.returned.push_back(writer.id);
    }
  });
  change(bus.readers, [](const auto& /*reader*/, auto& /*writer*/) {});
}
}  // namespace saphira::bus
