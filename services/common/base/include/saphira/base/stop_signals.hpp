#pragma once

namespace saphira {

/// A descriptor that is readable once SIGTERM or SIGINT has come. Call it before any thread begins:
/// the signals are blocked in all of them. SIGPIPE is ignored: a failed write reports it.
int stop_on_signals();

}  // namespace saphira
