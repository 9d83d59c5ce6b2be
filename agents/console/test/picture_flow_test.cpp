#include "saphira/console/picture_flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <vector>

namespace saphira::console {
namespace {

/// A camera with ten pictures a second, and a link that delays each way and carries so many bytes.
/// Of so many pictures one is lost on its way. It comes after a repetition, and the later ones of
/// its connection after it, as with TCP.
struct Link {
  double delay = 0.0;  // [s] each way
  double bytes = 1e9;  // [1/s]
  std::size_t lanes = 1;
  int lost = 0;         // one of so many pictures; 0: none
  int shown = 0;        // pictures that no later one has overtaken
  double oldest = 0.0;  // [s] the greatest age on the screen, after the first ten
  int least = 100;      // quality

  void run(double seconds) {
    struct Event {
      double at;
      std::uint64_t number;
      double captured;
    };
    struct Lane {
      std::deque<Event> arrivals;
      std::deque<Event> answers;
    };
    PictureFlow flow;
    std::vector<Lane> all(lanes);
    for (std::size_t lane = 0; lane < lanes; ++lane)
      flow.open(lane);
    double free = 0.0;  // when the link has sent what it has
    int sent = 0;
    std::uint64_t newest = 0;
    for (int ms = 0; ms < 1000 * seconds; ++ms) {
      const double now = ms / 1000.0;
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        auto& [arrivals, answers] = all[lane];
        while (!arrivals.empty() && arrivals.front().at <= now) {
          const Event& picture = arrivals.front();
          if (picture.number > newest && ++shown > 10)
            oldest = std::max(oldest, now - picture.captured);
          newest = std::max(newest, picture.number);
          answers.push_back({now + delay, picture.number, 0.0});
          arrivals.pop_front();
        }
        while (!answers.empty() && answers.front().at <= now) {
          flow.acknowledged(lane, answers.front().number, now);
          answers.pop_front();
        }
        const auto number = static_cast<std::uint64_t>(ms / 100 + 1);
        if (!flow.takes(lane, number, now))
          continue;
        const int quality = flow.quality() == 0 ? 60 : flow.quality();
        least = std::min(least, quality);
        free = std::max(free, now) + 12000.0 * quality / 60.0 / bytes;
        const bool again = lost > 0 && ++sent % lost == 0;
        const double at = free + delay + (again ? 0.2 + 2.0 * delay : 0.0);
        arrivals.push_back(
            {arrivals.empty() ? at : std::max(at, arrivals.back().at), number, (ms / 100) / 10.0});
        flow.sent(lane, number, now);
      }
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

// Several connections share the link: each sees that it is full.
TEST(PictureFlow, SeveralConnectionsStayFreshAsWell) {
  for (const double bytes : {60e3, 20e3}) {
    Link narrow{.delay = 0.1, .bytes = bytes, .lanes = 3};
    narrow.run(30.0);
    EXPECT_GE(narrow.shown, 120) << bytes;
    EXPECT_LE(narrow.oldest, 0.95) << bytes;
  }
}

// One in five: a picture of some packets, of which 5 % are lost.
TEST(PictureFlow, ALostPacketDelaysThePicturesOfItsConnectionAlone) {
  Link one{.delay = 0.25, .lost = 5};
  one.run(60.0);
  Link three{.delay = 0.25, .lanes = 3, .lost = 5};
  three.run(60.0);
  EXPECT_GE(three.shown, 5 * 60);
  EXPECT_LE(three.oldest, 0.8);
  EXPECT_GT(one.oldest, 0.9);
  EXPECT_LT(one.shown, three.shown);
}

TEST(PictureFlow, QualityComesBackWithTheLink) {
  PictureFlow flow;
  flow.open(0);
  std::uint64_t number = 0;
  double now = 0.0;
  const auto pass = [&](double took) {
    flow.sent(0, ++number, now);
    flow.acknowledged(0, number, now + took);
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
  flow.open(0);
  flow.sent(0, 1, 0.0);
  flow.acknowledged(0, 1, 0.05);
  flow.sent(0, 2, 1.0);
  EXPECT_FALSE(flow.takes(0, 3, 10.0));
  flow.acknowledged(0, 7, 10.0);  // never sent
  EXPECT_FALSE(flow.takes(0, 3, 10.0));
  flow.acknowledged(0, 2, 10.0);
  EXPECT_TRUE(flow.takes(0, 3, 10.0));
  EXPECT_FALSE(flow.takes(0, 2, 10.0));
}

}  // namespace
}  // namespace saphira::console
