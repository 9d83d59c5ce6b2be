// The cases of peers.txt: the test is the programs and their endpoints.
#include "peers.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <sstream>

#include "lines.hpp"

namespace saphira::bus::internal {
namespace {

/// Of "1.2": the second end of the first program.
WriterId end_of(const std::string& text) {
  WriterId id{};
  std::istringstream in(text);
  int program = 0;
  int end = 0;
  char point = 0;
  in >> program >> point >> end;
  id[0] = static_cast<std::uint8_t>(program);
  id[15] = static_cast<std::uint8_t>(end);
  return id;
}

Peers::Program program(const std::string& number) {
  return Peers::program_of(end_of(number));
}

std::string in_words(const std::vector<WriterId>& ends) {
  return joined(ends, " ", [](const WriterId& end) {
    return std::to_string(end[0]) + "." + std::to_string(end[15]);
  });
}

/// One case.
class Presences : public saphira::test::LinePlayer {
 public:
  Presences() {
    peers_.add(ends_);
    for (const char* const end : {"1.1", "1.2", "2.1"})
      peers_.match(ends_, end_of(end));
    peers_.expect(program("1"));
    peers_.tick({program("1")});
    wake_->clear();
    events_ = {ON("tick", tick(1, in)),
               ON("silence", tick(ticks(read<std::string>(in)), in)),
               ON("hears", tick(ticks(read<std::string>(in)), in)),
               ON("match", peers_.match(ends_, end_of(rest(in)))),
               ON("unmatch", peers_.unmatch(ends_, end_of(rest(in)))),
               ON("expect", peers_.expect(program(rest(in)))),
               ON("join", peers_.join(program(rest(in)))),
               ON("leave", peers_.leave(program(rest(in)))),
               ON("forget", peers_.forget(program(rest(in)))),
               ON("restart", peers_.restart(ends_))};
    facts_ = {IS("present", std::to_string(ends_.present())),
              IS("lost", in_words(peers_.take_lost(ends_))),
              IS("returned", in_words(peers_.take_returned(ends_))),
              IS("any absent", yes(peers_.any_absent(ends_))),
              IS("absent", absent()),
              IS("wakes", wakes())};
  }

 private:
  /// Of "20", or of a name of Peers, perhaps less one.
  static int ticks(const std::string& text) {
    const std::map<std::string, int> known{{"silent", Peers::kSilent},
                                           {"silent-at-first", Peers::kSilentAtFirst},
                                           {"restart", Peers::kRestart}};
    const bool less = text.ends_with("-1");
    const auto found = known.find(text.substr(0, text.size() - (less ? 2 : 0)));
    return found == known.end() ? std::stoi(text) : found->second - (less ? 1 : 0);
  }
  void tick(int count, std::istringstream& in) {
    std::set<Peers::Program> heard;
    for (std::string number; in >> number;)
      heard.insert(program(number));
    for (; count > 0; --count)
      peers_.tick(heard);
  }
  std::string absent() const {
    std::vector<std::string> all;
    for (const char* const number : {"1", "2", "3", "4"})
      if (peers_.absent(program(number)))
        all.emplace_back(number);
    return joined(all, " ");
  }
  /// Since the last time.
  std::string wakes() {
    const bool pending = wake_->pending();
    wake_->clear();
    return yes(pending);
  }

  std::shared_ptr<Wake> wake_ = std::make_shared<Wake>();
  Peers peers_{wake_};
  Ends ends_{Ends::Side::writers};
};

TEST(Peers, AreThereAsWritten) {
  EXPECT_EQ(saphira::test::play<Presences>("idl/bus/test/peers.txt"), 14);
}

}  // namespace
}  // namespace saphira::bus::internal
