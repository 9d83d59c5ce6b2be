#include "saphira/bus/gateway.hpp"

#include <map>
#include <set>
#include <string>

#include "internal.hpp"

namespace saphira::bus {
namespace {

NodeOptions for_inside(const Node& outside) {
  NodeOptions options = outside.options();
  options.name += "-gateway";
  return options;
}

/// Of these only the newest sample counts, so nothing is lost while nobody reads them.
bool is_periodic(Qos qos) {
  return qos == Qos::cyclic || qos == Qos::motion || qos == Qos::recall;
}

}  // namespace

struct Gateway::Out {
  const char* topic;
  Qos qos;
  const TypeInfo* type;
  std::unique_ptr<RawWriter> outside;
  std::unique_ptr<RawReader> inside;  ///< none while nobody outside reads a periodic topic

  void carry() {
    if (!inside)
      return;
    inside->take([this](const void* sample, const SampleInfo& info) {
      if (info.disposed)
        outside->dispose(sample);
      else
        outside->write(sample);
    });
  }
};

struct Gateway::In {
  const char* topic;
  Qos qos;
  const TypeInfo* type;
  std::unique_ptr<RawReader> outside;
  std::map<WriterId, std::unique_ptr<RawWriter>> inside;  ///< one for each writer outside

  void carry(Node& node, internal::Transport& self) {
    const std::vector<WriterId> gone = outside->take_lost();
    outside->take([&](const void* sample, const SampleInfo& info) {
      if (self.is_own(info.writer))
        return;  // our own copy, carried outwards
      auto& writer = inside[info.writer];
      if (!writer)
        writer = node.make_writer(topic, qos, *type);
      writer->set_sender(info.sender);
      if (info.disposed)
        writer->dispose(sample);
      else
        writer->write(sample);
    });
    for (const WriterId& writer : gone)
      inside.erase(writer);
  }
};

Gateway::Gateway(Node& outside, std::shared_ptr<MemoryBus> inside)
    : outside_(outside), inside_(std::make_unique<Node>(for_inside(outside), std::move(inside))) {
  std::set<std::string> written;
  std::set<std::string> read;
  for (const EndpointEntry& entry : internal::transport_of(*inside_).endpoints())
    (entry.writer ? written : read).insert(entry.topic);
  for_each_topic([&]<class T>(const Topic<T>& topic) {
    const bool one_source = is_periodic(topic.qos) || topic.qos == Qos::latched;
    if (written.contains(topic.name)) {
      auto out = std::make_unique<Out>(Out{topic.name, topic.qos, &type_of<T>(), nullptr, nullptr});
      out->outside = outside_.make_writer(topic.name, topic.qos, *out->type);
      if (!is_periodic(topic.qos))
        out->inside = inside_->make_reader(topic.name, topic.qos, *out->type);
      outs_.push_back(std::move(out));
    }
    if (read.contains(topic.name) && !(one_source && written.contains(topic.name)))
      ins_.push_back(
          std::make_unique<In>(In{topic.name,
                                  topic.qos,
                                  &type_of<T>(),
                                  outside_.make_reader(topic.name, topic.qos, type_of<T>()),
                                  {}}));
  });
}

Gateway::~Gateway() = default;

void Gateway::wait(std::chrono::milliseconds timeout, const Stop& stop) {
  woken_ = outside_.wait(timeout, &stop) || woken_;
}

void Gateway::carry() {
  // This thread looks by itself: incoming samples need not wake it.
  outside_.rouse();
  inside_->rouse();
  if (internal::wake_of(outside_).pending() || woken_) {
    woken_ = false;
    outside_.clear_wake();
    for (const auto& out : outs_) {
      if (!is_periodic(out->qos))
        continue;
      const bool wanted = out->outside->matched() > 0;
      if (wanted && !out->inside)
        out->inside = inside_->make_reader(out->topic, out->qos, *out->type);
      else if (!wanted)
        out->inside.reset();
    }
    for (const auto& in : ins_)
      in->carry(*inside_, internal::transport_of(outside_));
  }
  if (internal::wake_of(*inside_).pending()) {
    inside_->clear_wake();
    for (const auto& out : outs_)
      out->carry();
  }
}

}  // namespace saphira::bus
