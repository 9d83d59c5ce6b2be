#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace saphira::mcp {

/// The clients of a server of HTTP: which of them are there, whose goals end, and whose place a new
/// one takes. Pure: times are [s] of any clock that never goes back.
class Clients {
 public:
  /// A client as its connections and its door show it.
  struct State {
    int connections = 0;   ///< open
    double heard = 0.0;    ///< [s] newest acknowledgment from the other side of any of them
    bool streams = false;  ///< a ping reaches it
    bool waits = false;    ///< a call is not answered yet
    bool busy = false;     ///< a goal is underway
    bool silent = false;   ///< its person is asked if that may begin: it says nothing meanwhile
  };

  /// The one that gives its place to a new client: of those without a goal the longest silent,
  /// before those that wait for an answer. Empty: there is room. Nothing: all have goals.
  std::optional<std::string> place() const;
  /// A new client, until end(). Its name in public, from its own and a number of this server.
  std::string begin(const std::string& id, const std::string& name, double now);
  void end(const std::string& id) { all_.erase(id); }

  /// A message of the client. hidden: a proxy has passed it on. Until the next message its
  /// connections are those of the proxy, which keeps them when the client has gone.
  void came(const std::string& id, bool hidden, double now);
  /// The message is the answer to a ping: from now on silence after a ping is absence. A tunnel
  /// that nothing shows hides its client, too.
  void answered(const std::string& id) { all_.at(id).answers = true; }
  /// Call before each decision, and at least ten times a second.
  void see(const std::string& id, const State& state, double now);

  /// Its goals end now: they are underway, and the client is not there. True once for each absence.
  bool loses_goals(const std::string& id, double now);
  /// Its messages alone say that it is there.
  bool is_hidden(const std::string& id) const { return all_.at(id).hidden; }
  bool is_gone(const std::string& id, double now) const;
  bool is_pinged(const std::string& id, double now);
  /// Fewer than kMostBusy others have goals, so there is always a place for one that only stops.
  bool may_begin(const std::string& id) const;

  /// The client of all messages that have no place, and may only stop. It takes none itself.
  static constexpr const char* kNobody = "";
  static constexpr std::size_t kMost = 9;
  static constexpr std::size_t kMostBusy = 8;
  static constexpr double kSilent = 30.0;  ///< [s] without a goal
  /// [s] enough for a client that connects again after a second, and for a robot that has to stand
  /// 3 s after a kill.
  static constexpr double kAbsent = 1.5;
  static constexpr double kPing = 0.5;  ///< [s] between two

 private:
  struct Client {
    double asked = 0.0;  ///< [s] newest message
    double seen = 0.0;   ///< [s] newest sign
    State state = {};
    bool hidden = false;
    bool answers = false;  ///< pings
    bool lost = false;     ///< its goals, in this absence
    double pinged = 0.0;   ///< [s]
  };
  std::map<std::string, Client> all_;
  std::size_t count_ = 0;
};

}  // namespace saphira::mcp
