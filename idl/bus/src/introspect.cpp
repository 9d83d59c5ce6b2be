#include "saphira/bus/introspect.hpp"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "internal.hpp"
#include "saphira/base/text.hpp"

namespace saphira::bus {
namespace {

std::string no_such(const std::string& topic) {
  return "no topic \"" + topic + "\"; there are " + joined(known_topics(), ", ", &TopicEntry::name);
}

}  // namespace

std::vector<TopicEntry> known_topics() {
  std::vector<TopicEntry> result;
  for_each_topic([&]<class T>(const Topic<T>& topic) {
    result.push_back({topic.name, type_of<T>().name, internal::qos_name(topic.qos)});
  });
  return result;
}

Echo::Echo(Node& node, const std::string& topic) {
  for_each_topic([&]<class T>(const Topic<T>& known) {
    if (topic != known.name)
      return;
    type_ = &type_of<T>();
    reader_ = node.make_reader(known.name, known.qos, *type_);
  });
  if (!reader_)
    throw std::runtime_error(no_such(topic));
}

Echo::~Echo() = default;

std::vector<std::string> Echo::take_json() {
  std::vector<std::string> result;
  reader_->take([&](const void* sample, const SampleInfo& info) {
    result.push_back(type_->json(sample, info.disposed ? kDisposed.data() + 1 : ""));
  });
  return result;
}

std::size_t Echo::matched() const {
  return reader_->matched();
}

Scribe::Scribe(Node& node, const std::string& topic) {
  for_each_topic([&]<class T>(const Topic<T>& known) {
    if (topic != known.name)
      return;
    type_ = &type_of<T>();
    writer_ = node.make_writer(known.name, known.qos, *type_);
  });
  if (!writer_)
    throw std::runtime_error(no_such(topic));
  sample_ = std::shared_ptr<void>(type_->create(), type_->destroy);
}

Scribe::~Scribe() = default;

bool Scribe::write(const std::string& json) {
  std::shared_ptr<void> sample(type_->create(), type_->destroy);
  type_->parse(json, sample.get());
  sample_ = std::move(sample);
  return writer_->write(sample_.get());
}

bool Scribe::dispose() {
  return writer_->dispose(sample_.get());
}

bool Scribe::dispose(const std::string& json) {
  const std::shared_ptr<void> sample(type_->create(), type_->destroy);
  type_->parse(json, sample.get());
  return writer_->dispose(sample.get());
}

bool Scribe::wait_acknowledged(int timeout_ms) {
  return writer_->wait_acknowledged(timeout_ms);
}

std::size_t Scribe::matched() const {
  return writer_->matched();
}

Census::Census(Node& node) : node_(&node) {
  internal::transport_of(node).watch_endpoints(true);
}

Census::~Census() {
  internal::transport_of(*node_).watch_endpoints(false);
}

std::vector<EndpointEntry> Census::endpoints() const {
  auto result = internal::transport_of(*node_).endpoints();
  const auto known = known_topics();
  for (auto& endpoint : result) {
    const auto topic = std::find_if(known.begin(), known.end(), [&](const TopicEntry& entry) {
      return entry.name == endpoint.topic;
    });
    endpoint.known_type = topic == known.end() || topic->type == endpoint.type;
  }
  const auto order = [](const EndpointEntry& entry) {
    return std::make_tuple(std::cref(entry.topic), !entry.writer, std::cref(entry.program),
                           std::cref(entry.id));
  };
  std::sort(result.begin(), result.end(),
            [&](const EndpointEntry& a, const EndpointEntry& b) { return order(a) < order(b); });
  return result;
}

std::vector<ProgramEntry> found_programs(Node& node) {
  auto result = internal::transport_of(node).programs();
  std::ranges::sort(result, {}, [](const ProgramEntry& entry) {
    return std::make_tuple(entry.name, entry.host, entry.pid);
  });
  return result;
}

std::vector<OtherProgram> Census::others() const {
  return internal::transport_of(*node_).others();
}

std::vector<Mismatch> Census::mismatches() const {
  std::vector<Mismatch> result;
  const auto all = endpoints();
  for (const auto& writer : all) {
    if (!writer.writer)
      continue;
    for (const auto& reader : all) {
      if (reader.writer || reader.topic != writer.topic ||
          !internal::partitions_meet(writer.robot, reader.robot))
        continue;
      if (auto why = why_incompatible(writer, reader); !why.empty())
        result.push_back({writer, reader, std::move(why)});
    }
  }
  return result;
}

}  // namespace saphira::bus
