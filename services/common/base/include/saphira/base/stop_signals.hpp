#pragma once

namespace saphira {

/// A descriptor that is readable once SIGTERM or SIGINT has come. Call it before any thread begins:
/// the signals are blocked in all of them. SIGPIPE is ignored: a write that fails tells it.
int stop_on_signals();

}  // namespace saphira
