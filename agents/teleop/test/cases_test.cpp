// The cases of pages.txt and keys.txt: the test is the operators' pages, and the keyboard.
#include <gtest/gtest.h>

#include <cmath>

#include "lines.hpp"
#include "pages.hpp"
#include "saphira/base/enumerators.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/text.hpp"
#include "saphira/teleop/control.hpp"
#include "saphira/teleop/key_drive.hpp"

namespace saphira::teleop {
namespace {

/// Two operators, of whom one at a time drives.
class Pages : public saphira::test::LinePlayer {
 public:
  Pages() {
    control_.join(1, "ann");
    control_.join(2, "bob");
    events_ = {
        {"pass", [this](auto& in) { now_ += read<double>(in); }},
        {"clock", [this](auto& in) { ahead_ += read<double>(in); }},
        {"ann", [this](auto& in) { page(1, in); }},
        {"bob", [this](auto& in) { page(2, in); }},
        {"holds", [this](auto& in) { samples(true, read<double>(in)); }},
        {"lets-go", [this](auto& in) { samples(false, read<double>(in)); }},
        {"waits", [this](auto& in) { waiting_.push_back(sample(read<std::string>(in), in)); }},
        {"arrives",
         [this](auto&) {
           refused_ = control_.drive(1, waiting_.front(), now_);
           waiting_.erase(waiting_.begin());
         }},
        {"sample", [this](auto& in) {
           refused_ = control_.drive(1, sample(read<std::string>(in), in), now_);
         }}};
    facts_ = {{"moves", [this] { return yes(control_.order(now_).active); }},
              {"moved", [this] { return format("%g", moved_); }},
              {"order", [this] { return order(); }},
              {"refused", [this] { return refused_; }},
              {"holder", [this] { return control_.state().name; }},
              {"let go", [this] { return control_.state().let_go; }},
              {"note", [this] { return control_.state().note; }},
              {"asked",
               [this] { return joined(control_.state().asked, " ", &Control::Operator::name); }}};
  }

 private:
  /// "held", "again" (the number of the one before), "free", or "v=nan" or "r=inf" for its
  /// velocity or rotation; and how late it is [s].
  Control::Sample sample(const std::string& what, std::istringstream& in) {
    double late = 0.0;
    in >> late;
    if (what == "again")
      --number_;
    const bool held = what != "free";
    Control::Sample made{++number_, now_ + ahead_ - late, held, held ? 0.2 : 0.0, 0.0, 100};
    if (what.starts_with("v="))
      made.velocity = std::stod(what.substr(2));
    if (what.starts_with("r="))
      made.rotation = std::stod(what.substr(2));
    return made;
  }
  /// Samples 20 times a second, each without delay.
  void samples(bool held, double duration) {
    for (const double end = now_ + duration; now_ < end; now_ += 0.05) {
      std::istringstream none;
      refused_ = control_.drive(1, sample(held ? "held" : "free", none), now_);
      control_.order(now_);
    }
  }
  void page(Control::OperatorId id, std::istringstream& in) {
    const auto what = read<std::string>(in);
    if (what == "takes")
      refused_ = control_.take(id, false, now_);
    else if (what == "takes-by-force")
      refused_ = control_.take(id, true, now_);
    else if (what == "asks")
      refused_ = control_.ask(id);
    else if (what == "gives-to-bob")
      refused_ = control_.give(id, 2, now_);
    else if (what == "releases")
      control_.release(id);
    else if (what == "leaves")
      control_.leave(id);
    else if (what == "is-silent")
      silence(read<double>(in));
    else
      refused_ = control_.drive(id, sample(what, in), now_);
  }
  void silence(double duration) {
    const double begin = now_;
    moved_ = 0.0;
    for (const double end = now_ + duration; now_ < end; now_ += 0.01)
      if (control_.order(now_).active)
        moved_ = std::round(100.0 * (now_ - begin)) / 100.0;
  }
  std::string order() {
    const Order order = control_.order(now_);
    return format("%s %g %d", order.source.c_str(), order.velocity, static_cast<int>(order.cycle));
  }

  Control control_;
  double now_ = 1000.0;
  double ahead_ = -777.0;  // [s] the operator's clock
  std::uint64_t number_ = 0;
  std::string refused_;
  double moved_ = 0.0;  // [s] of the newest silence, from its beginning
  std::vector<Control::Sample> waiting_;
};

/// Keys of a terminal; times are seconds from the start.
class Keyboard : public saphira::test::LinePlayer {
 public:
  Keyboard() {
    events_ = {{"limit", [this](auto& in) { drive_.set_max_velocity(read<double>(in)); }},
               {"pass", [this](auto& in) { now_ += read<double>(in); }},
               {"at", [this](auto& in) { now_ = read<double>(in); }},
               {"release", [this](auto&) { drive_.release(); }},
               {"type", [this](auto& in) {
                  input_ += saphira::test::replaced(
                      saphira::test::replaced(rest(in), "ESC", "\x1b"), "CTRL-C", "\x03");
                }}};
    for (std::size_t i = 0; i < kEnumerators<DriveKey>.size(); ++i)
      events_[std::string(kEnumeratorNames<DriveKey>.at(i))] = [this, i](auto&) {
        drive_.press(kEnumerators<DriveKey>.at(i), now_);
      };
    facts_ = {{"drives",
               [this] {
                 const Order order = drive_.order(now_);
                 return order.active ? format("%.3g", order.velocity) : "no";
               }},
              {"active", [this] { return yes(drive_.order(now_).active); }},
              {"turn",
               [this] {
                 return format("%g, move %d", drive_.order(now_).turn->by,
                               static_cast<int>(drive_.order(now_).turn->move));
               }},
              {"keys",
               [this] {
                 return joined(take_keys(input_), " ", [](DriveKey key) {
                   return kEnumeratorNames<DriveKey>.at(static_cast<std::size_t>(key));
                 });
               }},
              {"left", [this] { return std::to_string(input_.size()); }}};
  }

 private:
  KeyDrive drive_;
  double now_ = 0.0;
  std::string input_;
};

TEST(Teleop, IsAsWritten) {
  EXPECT_EQ(saphira::test::play<Pages>("agents/teleop/test/pages.txt"), 15);
  EXPECT_EQ(saphira::test::play<Keyboard>("agents/teleop/test/keys.txt"), 15);
}

}  // namespace
}  // namespace saphira::teleop
