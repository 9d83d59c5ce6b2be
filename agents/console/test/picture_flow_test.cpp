#include "saphira/console/picture_flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

namespace saphira::console {
namespace {

/// A camera with ten pictures a second, and a link that delays each way and carries so many
/// pictures a second of the best quality.
struct Link {
  double delay = 0.0;   // [s] each way
  double bytes = 1e9;   // [1/s]
  int shown = 0;        // pictures
  double oldest = 0.0;  // [s] the greatest age on the screen, after the first ten
  int least = 100;      // quality

  void run(double seconds) {
    PictureFlow flow;
    struct Event {
      double at;
      std::uint64_t number;
      double captured;
    };
    std::deque<Event> arrivals;
    std::deque<Event> answers;
    double free = 0.0;  // when the link has sent what it has
    for (int ms = 0; ms < 1000 * seconds; ++ms) {
      const double now = ms / 1000.0;
      while (!arrivals.empty() && arrivals.front().at <= now) {
        if (++shown > 10)
          oldest = std::max(oldest, now - arrivals.front().captured);
        answers.push_back({now + delay, arrivals.front().number, 0.0});
        arrivals.pop_front();
      }
      while (!answers.empty() && answers.front().at <= now) {
        flow.acknowledged(answers.front().number, now);
        answers.pop_front();
      }
      const auto number = static_cast<std::uint64_t>(ms / 100 + 1);
      if (!flow.takes(number, now))
        continue;
      const int quality = flow.quality() == 0 ? 60 : flow.quality();
      least = std::min(least, quality);
      free = std::max(free, now) + 12000.0 * quality / 60.0 / bytes;
      arrivals.push_back({free + delay, number, (ms / 100) / 10.0});
      flow.sent(number, now);
    }
  }
};

TEST(PictureFlow, ALongDelayCostsNoPictures) {
  for (const double delay : {0.0, 0.05, 0.25}) {
    Link link{.delay = delay};
    link.run(20.0);
    EXPECT_GE(link.shown, 190) << delay;
    EXPECT_LE(link.oldest, delay + 0.12) << delay;
    EXPECT_EQ(link.least, 60) << delay;
  }
}

TEST(PictureFlow, ANarrowLinkGetsPlainerPicturesAndStaysFresh) {
  Link mobile{.delay = 0.25, .bytes = 60e3};
  mobile.run(30.0);
  EXPECT_GE(mobile.shown, 240);
  EXPECT_LE(mobile.oldest, 0.8);
  EXPECT_LT(mobile.least, 60);

  Link narrow{.delay = 0.1, .bytes = 20e3};
  narrow.run(30.0);
  EXPECT_GE(narrow.shown, 120);
  EXPECT_LE(narrow.oldest, 0.9);
  EXPECT_EQ(narrow.least, 15);
}

TEST(PictureFlow, QualityComesBackWithTheLink) {
  PictureFlow flow;
  std::uint64_t number = 0;
  double now = 0.0;
  const auto pass = [&](double took) {
    flow.sent(++number, now);
    flow.acknowledged(number, now + took);
    now += 0.1;
  };
  pass(0.05);
  for (int i = 0; i < 4; ++i)
    pass(0.4);
  EXPECT_EQ(flow.quality(), 40);
  for (int i = 0; i < 85; ++i)
    pass(0.05);
  EXPECT_EQ(flow.quality(), 0);
}

TEST(PictureFlow, ALostPageGetsNothingMore) {
  PictureFlow flow;
  flow.sent(1, 0.0);
  flow.acknowledged(1, 0.05);
  flow.sent(2, 1.0);
  EXPECT_FALSE(flow.takes(3, 10.0));
  flow.acknowledged(7, 10.0);  // never sent
  EXPECT_FALSE(flow.takes(3, 10.0));
  flow.acknowledged(2, 10.0);
  EXPECT_TRUE(flow.takes(3, 10.0));
  EXPECT_FALSE(flow.takes(2, 10.0));
}

}  // namespace
}  // namespace saphira::console
