#include "latch_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "saphira/base/durable.hpp"

namespace saphira::bridge {

authority::Latches LatchFile::read() const {
  std::error_code error;
  if (path_.empty() || (!std::filesystem::exists(path_, error) && !error))
    return {};
  // The file exists because of a latch: an empty one is as bad as a damaged one.
  std::ifstream file(path_);
  std::string line;
  const bool whole = std::getline(file, line) && !file.eof();
  return authority::latches_from_text(whole ? line + "\n" : "?");
}

std::string LatchFile::write(const authority::Latches& latches) const {
  if (path_.empty())
    return {};
  const std::string text = authority::to_text(latches);
  std::error_code error;
  if (text.empty()) {
    std::filesystem::remove(path_, error);
    return error ? path_ + ": " + error.message() : "";
  }
  return replace_file(path_, text) ? "" : path_ + ": " + std::strerror(errno);
}

}  // namespace saphira::bridge
