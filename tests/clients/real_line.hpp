#pragma once

#include <chrono>
#include <string>

#include "line.hpp"

namespace saphira::test {

/// A line to a program, in real time.
class RealLine : public Line {
 public:
  static int local(const std::string& path);
  static int tcp(int port);
  /// A terminal at 9600 baud, with these clients' settings.
  static int terminal(const std::string& path);

  /// Takes the descriptor.
  explicit RealLine(int fd) : fd_(fd) {}
  ~RealLine() override;

  void send(const Wire& bytes) override;
  void wait(double seconds) override;
  double now() const override;
  /// True where the other end has gone.
  bool closed() const { return closed_; }

 protected:
  double patience() const override { return 20.0; }

 private:
  int fd_;
  bool closed_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace saphira::test
