#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace saphira::web {

/// The body of a request that comes in chunks (RFC 9112, 7.1), which libwebsockets 4.1 hands over
/// as they are.
class Chunks {
 public:
  /// Appends the content of the next bytes to `body`. False: they are no chunks.
  bool take(std::string_view bytes, std::string& body);
  /// The whole body has come.
  bool ended() const { return ended_; }

 private:
  bool read(std::string_view line);

  std::string line_;           ///< up to its end
  std::size_t left_ = 0;       ///< bytes of this chunk
  bool behind_chunk_ = false;  ///< the line between two chunks
  bool trailer_ = false;       ///< the lines behind the last chunk
  bool ended_ = false;
};

}  // namespace saphira::web
