#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace saphira::bus::test {

/// A writer outside the library: of any bytes, on any topic, as another vendor's mistake or a
/// hostile program has it.
class RawWriter {
 public:
  RawWriter(const std::string& robot, const std::string& topic, const std::string& type,
            bool keyed);
  ~RawWriter();

  bool matched() const;
  bool write(std::vector<std::uint8_t> bytes);
  /// By a clock that is ahead of this machine's [s].
  bool write(std::vector<std::uint8_t> bytes, double ahead);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The bytes of a Request, with encapsulation.
std::vector<std::uint8_t> bytes_of_request(const std::string& functor);
/// Of a MotorCommand.
std::vector<std::uint8_t> bytes_of_motor_command(double velocity, bool active);

}  // namespace saphira::bus::test
