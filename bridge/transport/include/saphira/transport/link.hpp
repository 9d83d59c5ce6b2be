#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "saphira/base/descriptor.hpp"
#include "saphira/transport/address.hpp"

namespace saphira::transport {

/// The bytes to and from a robot server. Never blocks: a host's name is looked up in a thread of
/// its own, which may outlive the link. A lost link is tried again, first after 50 ms, then less
/// often, at least twice a second. Times are seconds of a steady clock.
class Link {
 public:
  enum class State { closed, connecting, open };

  explicit Link(Address address) : address_(std::move(address)) {}
  ~Link();
  Link& operator=(Link&&) = delete;

  const Address& address() const { return address_; }
  State state() const { return state_; }
  /// -1 while closed.
  int fd() const { return fd_; }
  /// The events to poll the fd for.
  short poll_events() const;
  /// The reason why it is not open, in words.
  const std::string& trouble() const { return trouble_; }
  /// The time of the next advance; infinity where only the fd matters.
  double due() const;

  /// Connects when due, completes a connection in progress, sends queued bytes.
  void advance(double now);
  /// Appends the received bytes. False when the other side has gone: the link is then closed.
  bool read(std::vector<std::uint8_t>& out, double now);
  /// Sends the whole packet, or queues the part that the line does not take. False (and the link
  /// closed) where the line is dead, or so slow that commands would become stale in the queue.
  bool write(std::span<const std::uint8_t> bytes, double now);
  /// [bytes] that may be written now and leave room for a driver's next command.
  std::size_t room() const;
  void close(const std::string& why, double now = 0.0);

 private:
  void open(double now);
  void look_up(double now);
  void open_tcp(double now);
  void opened();
  bool flush(double now);
  std::size_t queued() const;
  void start_program(double now);
  void hear_program(double now);
  void reap();
  std::string hung_up() const;
  std::string failure() const;  ///< of errno

  Address address_;
  State state_ = State::closed;
  Descriptor fd_;
  std::string trouble_ = "not connected yet";
  double next_try_ = 0.0;
  double give_up_ = 0.0;
  double backoff_ = 0.0;
  struct LookUp;
  std::shared_ptr<LookUp> look_up_;  ///< under way, or done and not yet used
  std::size_t tries_ = 0;            ///< index into the addresses of the host's name, used in turn
  bool heard_ = false;               ///< bytes have arrived since it was opened
  std::vector<std::uint8_t> waiting_;
  std::vector<int> programs_;  ///< that were started and may still run
};

}  // namespace saphira::transport
