// The requests of requests.txt, between their askers and agents.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>
#include <utility>

#include "arguments.hpp"
#include "lines.hpp"
#include "saphira/agent_interface/facilitator.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/text.hpp"

namespace saphira::agent_interface {
namespace {

const std::vector<std::string> kCodes{"underway", "done",   "sent",     "refused", "unknown",
                                      "bad",      "nobody", "too-late", "gave-up", "lost"};

Arguments arguments_of(std::istringstream& in) {
  std::string text;
  std::getline(in, text);
  return test::arguments_of(text);
}

std::pair<std::uint64_t, std::uint64_t> id_of(const std::string& text) {
  return {std::stoull(text, nullptr, 16), std::stoull(text.substr(text.find(':') + 1))};
}

Identity identity_of(const std::string& text) {
  return {text.substr(0, text.find('/')), text.substr(text.find('/') + 1)};
}

/// One case.
class Round {
 public:
  /// An event and all that comes of it, or a fact.
  void take(const std::string& line) {
    const std::size_t colon = line.find(':');
    if (const auto fact = facts_.find(line.substr(0, colon)); fact != facts_.end()) {
      EXPECT_EQ(fact->second(), colon + 2 < line.size() ? line.substr(colon + 2) : "");
      return;
    }
    const std::size_t arrow = std::min(line.find(" => "), line.size());
    std::istringstream in(line.substr(0, arrow));
    std::string verb;
    in >> verb;
    if (const auto event = events_.find(verb); event != events_.end())
      event->second(in);
    else
      ADD_FAILURE() << "not understood: " << verb;
    step();
    EXPECT_EQ(heard_, arrow < line.size() ? line.substr(arrow + 4) : "");
  }

 private:
  void step() {
    out_ = facilitator_.step(now_);
    std::vector<std::string> all;
    for (const Request& request : out_.requests) {
      asked_ = request;
      const Identity who = request.person.value_or(Identity());
      all.push_back(name_of(request) + ": " + describe(request) +
                    (who.name.empty() ? "" : " for " + who.name));
    }
    for (const Solved& solved : out_.solved) {
      const Answer& answer = solved.answer;
      EXPECT_EQ(solved.asker, 1U);
      const std::string results = describe(answer.results);
      all.push_back(std::to_string(solved.number) + " " + solved.service +
                    (solved.service.empty() ? "" : " ") +
                    kCodes.at(static_cast<std::size_t>(answer.code)) +
                    (answer.text.empty() ? "" : " (" + answer.text + ")") +
                    (results.empty() ? "" : " ") + results);
    }
    if (!answer_.empty())
      all.push_back(std::exchange(answer_, {}));
    heard_ = joined(all, " | ");
  }
  static std::string name_of(const Request& request) {
    return request.service.substr(std::string("address of ").size());
  }
  template <class T>
  static T read(std::istringstream& in) {
    T value{};
    EXPECT_TRUE(in >> value);
    return value;
  }
  /// "agent 1 calendar", with "acts" and a cost.
  void announce(std::istringstream& in) {
    const auto id = read<std::uint64_t>(in);
    const auto name = read<std::string>(in);
    const std::string more(std::istreambuf_iterator<char>(in), {});
    const std::size_t cost = more.find("costs ");
    std::vector<Capability> all{
        {{"place_of",
          "where a person is",
          {text_parameter("person", "a name"), optional(text_parameter("place", "of the map"))}},
         more.find("acts") != std::string::npos,
         cost == std::string::npos ? 0.0 : std::stod(more.substr(cost + 6))}};
    if (more.find("notes") != std::string::npos)
      all.push_back({{"note", "", {optional(text_parameter("place", ""))}}, true, 0.0});
    if (more.find("goes") != std::string::npos)
      all = {{{"go",
               "goes there",
               {text_parameter("place", "of the map"),
                optional(number_parameter("metres", "of the way", 0.0, 100.0))}},
              true},
             {{"near",
               "a place beside another",
               {text_parameter("place", "of the map"),
                optional(text_parameter("other", "beside it"))}}}};
    facilitator_.announce({id, name, "address of " + name, all, member_});
  }
  /// "ask 5": where karen is; "ask 5 FUNCTOR ARGUMENTS" with "@within=2", "@of=robot",
  /// "@by=anna/agent".
  void ask(std::istringstream& in) {
    Request request;
    request.source = "a person";
    request.asker = 1;
    request.number = read<std::uint64_t>(in);
    request.functor = "place_of";
    std::string text = "person=karen place=?";
    if (in >> request.functor)
      std::getline(in, text);
    else
      request.functor = "place_of";
    for (const Argument& argument : test::arguments_of(text)) {
      if (argument.name == "@within")
        request.deadline = argument.number;
      else if (argument.name == "@of")
        request.service = argument.text;
      else if (argument.name == "@by")
        request.person = identity_of(argument.text);
      else
        request.arguments.push_back(argument);
    }
    facilitator_.ask(request, now_);
  }
  /// "done (in words) place=library"
  static Answer answer_of(std::istringstream& in) {
    const auto code = std::find(kCodes.begin(), kCodes.end(), read<std::string>(in));
    EXPECT_NE(code, kCodes.end());
    Answer answer{static_cast<AnswerCode>(code - kCodes.begin())};
    if (in >> std::ws && in.peek() == '(') {
      in.get();
      std::getline(in, answer.text, ')');
    }
    answer.results = arguments_of(in);
    return answer;
  }
  /// "trigger 1:4 every 5 times 2 does note", "... when moved person=karen does note place=?"
  void trigger(std::istringstream& in) {
    Trigger made;
    made.id = id_of(read<std::string>(in));
    made.source = "ann";
    Arguments* arguments = &made.action_arguments;
    for (std::string word; in >> word;) {
      if (word == "every")
        made.period = read<double>(in);
      else if (word == "times")
        made.times = read<std::uint64_t>(in);
      else if (word == "by")
        made.person = identity_of(read<std::string>(in));
      else if (word == "when" || word == "looks-at") {
        made.kind = word == "when" ? TriggerKind::event : TriggerKind::data;
        made.condition = read<std::string>(in);
        arguments = &made.condition_arguments;
      } else if (word == "does") {
        made.action = read<std::string>(in);
        arguments = &made.action_arguments;
      } else {
        arguments->push_back(test::arguments_of(word).at(0));
      }
    }
    facilitator_.set(made, now_);
  }
  /// Steps of a length; the agent answers each request at once. `fired` counts these.
  void run(std::istringstream& in) {
    const int steps = read<int>(in);
    const double length = read<double>(in);
    fired_ = 0;
    for (int i = 0; i < steps; ++i) {
      now_ += length;
      for (const Request& request : facilitator_.step(now_).requests) {
        ++fired_;
        facilitator_.hear(request.service, request.asker, request.number, {}, now_);
      }
    }
  }
  void restart(double known) {
    Facilitator next(++self_, now_ + known);
    const std::string kept = saved(facilitator_);
    restore(kept, next);
    EXPECT_EQ(saved(next), kept);
    facilitator_ = std::move(next);
  }
  std::string audit() const {
    std::vector<std::string> all;
    for (const v1::AuditEntry& entry : out_.audit)
      all.push_back(entry.act == v1::AUDIT_REFUSED ? "refused" : "asked");
    return joined(all, " ");
  }
  static std::string yes(bool is) { return is ? "yes" : "no"; }

  std::uint64_t self_ = 9;
  Facilitator facilitator_{self_};
  Checked member_;
  double now_ = 100.0;
  int fired_ = 0;
  Request asked_;       ///< newest
  std::string answer_;  ///< of the event itself
  Facilitator::Outputs out_;
  std::string heard_;

  using Event = std::function<void(std::istringstream&)>;
  const std::map<std::string, Event> events_ {
    {"member",  // who writes what follows
     [this](auto& in) { member_ = identity_of(read<std::string>(in)); }},
        ON("agent", announce(in)),
        ON("leaves", facilitator_.leave(read<std::uint64_t>(in), member_)), ON("ask", ask(in)),
        {"answer",  // to the newest request
         [this](auto& in) {
           facilitator_.hear(asked_.service, asked_.asker, asked_.number, answer_of(in), now_);
         }},
        {"hear",
         [this](auto& in) {
           const auto name = read<std::string>(in);
           const auto number = read<std::uint64_t>(in);
           facilitator_.hear("address of " + name, 1, number, answer_of(in), now_, member_);
         }},
        {"stranger",  // an answer from an address that no agent has
         [this](auto& in) {
           const auto address = read<std::string>(in);
           const auto number = read<std::uint64_t>(in);
           facilitator_.hear(address, 1, number, answer_of(in), now_);
         }},
        ON("pass", now_ += read<double>(in)),
        ON("until-due", now_ = facilitator_.due().value_or(-1.0)),
        ON("restart", restart(read<double>(in))), ON("trigger", trigger(in)),
        ON("take-back", facilitator_.take_back(id_of(read<std::string>(in)))),
        ON("miss", facilitator_.miss(id_of(read<std::string>(in)))),
        ON("call-off", facilitator_.call_off(id_of(read<std::string>(in)))),
        ON("event", const auto functor = read<std::string>(in);
           facilitator_.happened(functor, arguments_of(in), now_)),
        ON("may-change", const auto id = id_of(read<std::string>(in));
           answer_ = yes(facilitator_.may_change(id, identity_of(read<std::string>(in))))),
        ON("run", run(in))
  };
  const std::map<std::string, std::function<std::string()>> facts_{
      IS("open", std::to_string(facilitator_.open())),
      IS("due", std::to_string(std::lround(facilitator_.due().value_or(-1.0)))),
      IS("fired", std::to_string(fired_)),
      IS("changed", yes(out_.changed)),
      IS("remembers nothing", yes(saved(facilitator_) == saved(Facilitator(9)))),
      IS("asked as", std::to_string(asked_.asker) + ":" + std::to_string(asked_.number)),
      IS("deadline", std::to_string(std::lround(asked_.deadline))),
      IS("warnings", joined(out_.warnings, " | ")),
      IS("notes", joined(out_.notes, " | ")),
      IS("audit", audit())};
};

TEST(Requests, AreAsWritten) {
  EXPECT_EQ(test::play<Round>("services/agent_interface/test/requests.txt"), 44);
}

}  // namespace
}  // namespace saphira::agent_interface
