#include "key.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>

#include "saphira/base/descriptor.hpp"
#include "saphira/base/durable.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/full_disk.hpp"
#include "saphira/base/text.hpp"

namespace saphira::console {

namespace {

constexpr std::size_t kBytes = 12;

std::string text_of(const Kept& kept) {
  return kept.key + "\n" + (kept.port == 0 ? "" : std::to_string(kept.port) + "\n");
}

}  // namespace

std::string new_key() {
  return random_hex(kBytes);
}

Kept keep(const std::string& file) {
  if (file.empty())
    return {new_key(), 0};
  const Descriptor fd = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (fd < 0)
    fail_to_be(file, "opened", "; it is for the console's key");
  struct stat state {};
  std::array<char, 100> text{};
  const ssize_t size = read(fd, text.data(), text.size());
  std::istringstream content(
      std::string(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0));
  Kept kept;
  content >> kept.key >> kept.port;
  const bool open_to_others = fstat(fd, &state) != 0 || (state.st_mode & 077U) != 0;
  bool written = true;
  if (!open_to_others && kept.key.size() < 2 * kBytes) {
    kept = {new_key(), 0};
    written = overwrite(fd, text_of(kept));
  }
  if (open_to_others)
    throw UnusableFile(file + ": others may read the console's key; chmod 600 it, or remove it");
  if (!written)
    fail_to_be(file, "written", "; it is for the console's key");
  return kept;
}

std::string read_secret(const std::string& file) {
  std::ifstream in(file);
  struct stat state {};
  std::string secret;
  if (!(in >> secret) || stat(file.c_str(), &state) != 0)
    throw UnusableFile(file + ": expected a token");
  if ((state.st_mode & 077U) != 0)
    throw UnusableFile(file + ": others may read the token; chmod 600 it");
  return secret;
}

void keep_port(const std::string& file, const Kept& kept, int port) {
  if (file.empty() || kept.port == port)
    return;
  const Descriptor fd = open(file.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0 || !overwrite(fd, text_of({kept.key, port})))
    fail_to_be(file, "written", "; it is for the console's port");
}

}  // namespace saphira::console
