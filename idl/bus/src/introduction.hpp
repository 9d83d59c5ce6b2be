#pragma once

// The announcements of participants and the messages of their handshakes. They are in clear even
// where all else is encrypted, so that anybody can make them.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace saphira::bus::internal {

/// True where a sound message speaks for nobody but the participant that its header names: each
/// announcement and each part of a handshake in it has this GUID prefix inside, once, in the one
/// form that Fast DDS writes. A farewell has another form.
///
/// Fast DDS 2.9 takes the announced prefix from inside, and checks the prefix in the data of a
/// handshake with the certificate; it compares neither with the sender.
bool speaks_for_itself(const std::uint8_t* message, std::size_t size);

/// True where a sound message says that a participant has ended: it has a key in place of data, or,
/// as Fast DDS writes it, nothing but inline QoS.
bool is_farewell(const std::uint8_t* message, std::size_t size);

/// A program as its announcement describes it: its name, and its user data ("key=value;...").
struct Announced {
  std::string name;
  std::string data;
};

/// The name and the user data of the participant that a sound message announces; nothing where it
/// announces none, or in another form than Fast DDS writes.
std::optional<Announced> announced(const std::uint8_t* message, std::size_t size);

/// In a message that speaks_for_itself(): each announcement is good for so long, from its arrival.
void set_lease(std::uint8_t* message, std::size_t size, std::chrono::seconds lease);

/// In a sound message: each announcement has the next number. Fast DDS ignores one whose number it
/// knows, and would keep the lease of the first one.
void renumber(std::uint8_t* message, std::size_t size);

}  // namespace saphira::bus::internal
