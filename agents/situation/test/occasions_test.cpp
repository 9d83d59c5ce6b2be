#include "saphira/situation/occasions.hpp"

#include "lines.hpp"
#include "office.hpp"

namespace saphira::situation {
namespace {

/// `SECONDS CHANGE => EVENT`: the time since the line before, and a change of the drive.
class Watch {
 public:
  void take(const std::string& line) {
    const std::size_t change = line.find(' ') + 1;
    const std::size_t arrow = line.find(" => ");
    now_ += std::stod(line);
    json_.merge_patch(test::Json::parse(line.substr(change, arrow - change)));
    const auto found = occasions_.next(test::situation_of(json_), now_);
    EXPECT_EQ(found ? found->kind + ": " + found->text : "none", line.substr(arrow + 4));
  }

 private:
  test::Json json_ = test::driving_json();
  Occasions occasions_;
  double now_ = 100.0;
};

TEST(Occasions, AreAsWritten) {
  EXPECT_EQ(saphira::test::play<Watch>("agents/situation/test/occasions.txt"), 6);
}

}  // namespace
}  // namespace saphira::situation
