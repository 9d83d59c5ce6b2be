#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "requests/shell/desk.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/notes.hpp"
#include "saphira/bus/cycle.hpp"
#include "saphira/bus/request_client.hpp"

namespace saphira::runtime {

/// One line of the system's table: a topic, as a service uses it.
struct Port {
  enum class Use {
    kState,    ///< in: robot/state of cycle N, and the robot's description of its epoch
    kCycle,    ///< in: of cycle N-1; lockstep waits for it
    kNewest,   ///< in: the newest sample
    kEvents,   ///< in: every sample, in a cycle or between two
    kEach,     ///< out: one sample a cycle
    kChanges,  ///< out: on change
    kRecall    ///< out: kEach again, kept for a minute for later readers
  };
  std::string topic;
  Use use = Use::kEach;

  bool is_input() const { return use <= Use::kEvents; }
  friend bool operator==(const Port&, const Port&) = default;
};

/// The use of a topic, in a word or two, for people.
const char* word(Port::Use use);

/// The stamp of a sample: the newest step of its service.
class Stamper {
 public:
  explicit Stamper(const bus::Cycle& cycle) : cycle_(&cycle) {}
  template <class T>
  void stamp(T& sample) const {
    if constexpr (requires { sample.stamp = cycle_->stamp(); })
      sample.stamp = cycle_->stamp();
  }

 private:
  const bus::Cycle* cycle_;
};

/// A topic that a service writes. It adds the stamp.
template <class T>
class Output {
 public:
  Output(bus::Writer<T> writer, Stamper stamper) : writer_(std::move(writer)), stamper_(stamper) {}

  /// Stamps the sample and writes it; false where the bus did not take it.
  bool write(T& sample) {
    stamper_.stamp(sample);
    return writer_.write(sample);
  }
  bool write(T&& sample) { return write(sample); }
  /// Withdraws the instance that has the sample's key.
  bool dispose(T sample) {
    stamper_.stamp(sample);
    return writer_.dispose(sample);
  }

 private:
  bus::Writer<T> writer_;
  Stamper stamper_;
};

/// Sends requests to other programs.
class Asker {
 public:
  Asker(bus::Node& node, const bus::Cycle& cycle, const bus::RequestTopic& topic)
      : node_(&node), cycle_(&cycle), writer_(node.writer<v1::Request>(topic)) {}

  /// Sends a request; `number`: of it in the answers. In lockstep it returns when every program
  /// that takes such requests has it: any program that knows the service's later samples knows the
  /// request, too.
  void ask(Request request, std::uint64_t number = bus::next_request_number());
  /// True where some program takes such requests.
  bool is_taken() const { return writer_.matched() > 0; }

 private:
  bus::Node* node_;
  const bus::Cycle* cycle_;
  bus::Writer<v1::Request> writer_;
};

/// The declaration of a service: its topics on the bus. A service takes its inputs and outputs from
/// here in its constructor; the shell knows them all from then on.
class Ports {
 public:
  /// For a shell. All arguments outlive this.
  Ports(bus::Node& node, bus::Cycle& cycle);

  /// A cyclic topic of another service, of cycle N-1.
  template <class T>
  bus::Input<T>& cycle(const bus::Topic<T>& topic) {
    declare(topic.name, Port::Use::kCycle);
    return cycle_.input(topic);
  }
  /// A topic whose newest sample may be read at any time.
  template <class T>
  bus::Reader<T> newest(const bus::Topic<T>& topic) {
    declare(topic.name, Port::Use::kNewest);
    return node_.reader(topic);
  }
  /// A topic of which no sample may be missed.
  template <class T>
  bus::Reader<T> events(const bus::Topic<T>& topic) {
    declare(topic.name, Port::Use::kEvents);
    return node_.reader(topic);
  }
  template <class T>
  Output<T> each_cycle(const bus::Topic<T>& topic) {
    return output(topic, Port::Use::kEach);
  }
  template <class T>
  Output<T> changes(const bus::Topic<T>& topic) {
    return output(topic, Port::Use::kChanges);
  }
  template <class T>
  Output<T> recall(const bus::Topic<T>& topic) {
    return output(topic, Port::Use::kRecall);
  }
  /// Takes requests that fit `functors`. The service takes and answers them in each step, and
  /// between two.
  Desk& requests(const bus::RequestTopic& topic, std::vector<Functor> functors);
  /// Sends requests on such a topic.
  Asker asker(const bus::RequestTopic& topic) {
    declare(topic.name, Port::Use::kChanges);
    return {node_, cycle_, topic};
  }
  /// Asks on such a topic, and hears the answers.
  bus::RequestClient client(const bus::RequestTopic& topic) {
    declare(topic.name, Port::Use::kChanges);
    declare(topic.answers.name, Port::Use::kEvents);
    return {node_, topic, name()};
  }

  /// Further conditions of a step, for which lockstep waits (bus::Cycle::gate).
  void gate(bus::Cycle::Gate missing) { cycle_.gate(std::move(missing)); }

  /// Makes the shell check the gates again: from any thread, when their inputs may be here.
  void wake() { node_.wake(); }

  /// The service's name on the bus.
  const std::string& name() const { return node_.options().name; }
  bool lockstep() const { return node_.options().lockstep; }
  Files files() const { return node_.options().files(); }
  /// Random, one a process start.
  std::uint64_t instance() const { return node_.instance(); }
  /// Of the newest step.
  const v1::Stamp& stamp() const { return cycle_.stamp(); }

  /// Writes notes to the program's log.
  void say(const std::vector<Note>& notes);
  /// The status gives the reason, until the next step: the service works, with limitations.
  void degrade(const std::string& reason);

  const std::vector<Port>& table() const { return table_; }

 private:
  void declare(const char* topic, Port::Use use) { table_.push_back({topic, use}); }
  template <class T>
  Output<T> output(const bus::Topic<T>& topic, Port::Use use) {
    declare(topic.name, use);
    return {node_.writer(topic), Stamper(cycle_)};
  }

  bus::Node& node_;
  bus::Cycle& cycle_;
  std::vector<std::unique_ptr<Desk>> desks_;
  std::vector<Port> table_;
};

}  // namespace saphira::runtime
