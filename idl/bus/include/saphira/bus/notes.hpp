#pragma once

#include "saphira/base/notes.hpp"
#include "saphira/bus/node.hpp"

namespace saphira::bus {

/// Writes a core's note to the program's log.
inline void log(Node& node, const Note& note) {
  switch (note.level) {
    case Note::Level::info:
      return node.info(note.text);
    case Note::Level::warning:
      return node.warn(note.text);
    case Note::Level::error:
      return node.error(note.text);
  }
}

}  // namespace saphira::bus
