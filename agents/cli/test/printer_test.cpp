#include "saphira/cli/printer.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>

namespace saphira::cli {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A pipe without a reader until the test reads.
struct Pipe {
  Pipe() {
    EXPECT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
    std::signal(SIGPIPE, SIG_IGN);
  }
  ~Pipe() {
    stop_reading();
    ::close(ends[1]);
  }
  void stop_reading() {
    if (ends[0] >= 0)
      ::close(ends[0]);
    ends[0] = -1;
  }
  /// Reads exactly that much.
  std::string read(std::size_t size) {
    std::string text(size, '\0');
    std::size_t done = 0;
    while (done < size) {
      const ssize_t n = ::read(ends[0], text.data() + done, size - done);
      if (n <= 0)
        break;
      done += static_cast<std::size_t>(n);
    }
    text.resize(done);
    return text;
  }
  std::array<int, 2> ends{};
};

TEST(Printer, PrintsInOrder) {
  Pipe pipe;
  Printer printer(pipe.ends[1]);
  printer.print("one\n");
  printer.print("two\n");
  EXPECT_TRUE(printer.flush(seconds(30)));
  EXPECT_EQ(pipe.read(8), "one\ntwo\n");
}

TEST(Printer, NobodyWaitsForAFullPipe) {
  Pipe pipe;
  Printer printer(pipe.ends[1], 1000);
  const std::string line = std::string(999, 'x') + "\n";
  int lines = 0;
  do
    printer.print(line);
  while (printer.flush(milliseconds(20)) && ++lines < 1000);
  ASSERT_LT(lines, 1000) << "the pipe never was full";
  for (int i = 0; i < 1000; ++i)
    printer.print(line);  // at once, or this test never ends
  std::string all;
  while (all.find("left out") == std::string::npos) {
    all += pipe.read(1);
    if (all.size() > 200000)
      FAIL() << "nothing says that something was left out";
  }
}

TEST(Printer, OfPicturesThatWaitTheNewestIsShown) {
  Pipe pipe;
  Printer printer(pipe.ends[1]);
  const std::string big(1U << 17U, '.');
  printer.show(big);  // blocks the thread, or waits and is replaced
  for (int i = 0; i <= 1000; ++i)
    printer.show("picture " + std::to_string(i) + "\n");
  std::string all;
  while (all.find("picture 1000\n") == std::string::npos) {
    const std::string more = pipe.read(1);
    ASSERT_FALSE(more.empty());
    all += more;
  }
  EXPECT_LT(all.size(), big.size() + 2000) << "hardly any of the thousand";
  EXPECT_TRUE(printer.flush(seconds(30)));
}

TEST(Printer, ItsEndDoesNotWait) {
  Pipe pipe;
  Printer printer(pipe.ends[1]);
  printer.print(std::string(1U << 17U, 'x'));
  // The destructor returns in spite of the blocked thread, or this test never ends.
}

TEST(Printer, NoticesThatNobodyWillEverRead) {
  Pipe pipe;
  Printer printer(pipe.ends[1]);
  pipe.stop_reading();
  printer.print("into nothing\n");
  EXPECT_TRUE(printer.flush(seconds(30)));
  EXPECT_TRUE(printer.closed());
  EXPECT_EQ(printer.trouble(), "");
}

TEST(Printer, NamesTheReasonWhereNothingCanBeWritten) {
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  ASSERT_GE(full, 0);
  {
    Printer printer(full);
    EXPECT_EQ(printer.trouble(), "");
    printer.print("nowhere to go\n");
    EXPECT_TRUE(printer.flush(seconds(30)));
    EXPECT_TRUE(printer.closed());
    EXPECT_EQ(printer.trouble(), "could not write the output: No space left on device");
  }
  ::close(full);
}

}  // namespace
}  // namespace saphira::cli
