#pragma once

#include <string>

namespace saphira::console {

/// Random, in hexadecimal digits. std::runtime_error where the system has no random numbers.
std::string new_key();

/// The key and the port: with the same ones, open pages continue after a restart.
struct Kept {
  std::string key;
  int port = 0;  ///< known to pages; 0: none yet
};

/// Reads key and port from the file. Where it has no key, writes a new one there, which only the
/// owner can read. Without a file name: a new key. std::runtime_error that names the file where it
/// is open to others or cannot be written.
Kept keep(const std::string& file);
/// The first word of a file that only its owner may read. std::runtime_error that names the file.
std::string read_secret(const std::string& file);
/// Saves the port as well. std::runtime_error that names the file.
void keep_port(const std::string& file, const Kept& kept, int port);

}  // namespace saphira::console
