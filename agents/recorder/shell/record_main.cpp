// Records the bus as an MCAP file. README.md.
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <stdexcept>
#include <string>
#include <vector>

#include "held.hpp"
#include "last_minute.hpp"
#include "recorder.hpp"
#include "saphira/base/boot_clock.hpp"
#include "saphira/base/format.hpp"
#include "saphira/base/full_disk.hpp"
#include "saphira/base/text.hpp"
#include "saphira/bus/program.hpp"

namespace {

using namespace saphira;
using Clock = std::chrono::steady_clock;

constexpr auto kTurn = std::chrono::milliseconds(20);
constexpr auto kFlush = std::chrono::seconds(1);
constexpr auto kListen = std::chrono::seconds(2);  // to what is kept, and what comes after it

struct Options {
  std::string file;
  std::vector<std::string> topics;
  double seconds = 0.0;
  bool overwrite = false;
  bool last_minute = false;
};

std::string usual_name(const std::string& robot) {
  return robot + local_text(std::time(nullptr), "-%Y-%m-%d-%H%M%S.mcap");
}

int keep_last_minute(bus::Node& node, recorder::Held& held, const std::string& file,
                     const bus::Stop& stop) {
  // The robot and its people come first.
  (void)!nice(10);
  recorder::LastMinute minute(node);
  const auto began = Clock::now();
  while (!stop.requested() && Clock::now() - began < kListen) {
    node.wait(kTurn, &stop);
    node.publish_status();
    minute.poll(unix_nanoseconds());
  }
  recorder::Writer writer(held.out());
  if (!minute.write(node, writer)) {
    std::fprintf(stderr, "saphira: no robot is heard; saphira status shows which programs run\n");
    return bus::kExitFailed;
  }
  if (!writer.close())
    fail_to_be(file, "written");
  held.keep();
  std::printf("%s\n", file.c_str());
  return bus::kExitOk;
}

int record(const bus::NodeOptions& node_options, const Options& options, const bus::Stop& stop) {
  const std::string file = options.file.empty() ? usual_name(node_options.robot) : options.file;
  const auto topics = recorder::recorded_topics(options.topics);
  recorder::Held held(file, options.overwrite);
  bus::Node node(node_options);
  node.status().state = v1::SERVICE_RUNNING;
  if (options.last_minute)
    return keep_last_minute(node, held, file, stop);
  recorder::Writer writer(held.out());
  recorder::Recorder recorder(node, writer, topics);
  for (const std::string& topic : recorder.refused())
    std::fprintf(stderr, "saphira: not recorded: %s\n", topic.c_str());
  std::fprintf(stderr, "records robot %s to %s; Ctrl-C ends it\n", node_options.robot.c_str(),
               file.c_str());
  const auto began = Clock::now();
  auto flushed = began;
  while (!stop.requested() &&
         (options.seconds <= 0.0 ||
          Clock::now() - began < std::chrono::duration<double>(options.seconds))) {
    node.wait(kTurn, &stop);
    node.publish_status();
    recorder.poll(unix_nanoseconds());
    if (Clock::now() - flushed >= kFlush) {
      flushed = Clock::now();
      if (!writer.flush())
        fail_to_be(file, "written");
      if (recorder.has_heard())
        held.keep();
    }
  }
  recorder.poll(unix_nanoseconds());
  if (!writer.close())
    fail_to_be(file, "written");
  if (recorder.has_heard())
    held.keep();
  const std::chrono::duration<double> lasted = Clock::now() - began;
  std::fprintf(stderr, "%llu samples in %.0f s, %.1f MB\n",
               static_cast<unsigned long long>(writer.samples()), lasted.count(),
               static_cast<double>(writer.bytes()) / 1e6);
  if (!recorder.has_heard())
    std::fprintf(stderr, "saphira: nothing was said; saphira status shows which programs run\n");
  return recorder.has_heard() ? bus::kExitOk : bus::kExitFailed;
}

}  // namespace

int main(int argc, char** argv) {
  Options own;
  return bus::run_program(
      argc, argv, "record", "Records the bus as an MCAP file with JSON messages",
      [&](CommandLine& app) {
        app.add_option("file", own.file, "FILE.mcap; else ROBOT-DATE-TIME.mcap in this folder");
        app.add_option("--topic", own.topics, "this one alone; may be repeated").one_value_each();
        app.add_flag("--overwrite", own.overwrite, "replace a recording of that name");
        app.add_flag("--last-minute", own.last_minute,
                     "what its programs keep of the last minute, which is written at once");
        app.add_option("--for", own.seconds, "[s] end then").positive();
      },
      [&](const bus::NodeOptions& options, const bus::Stop& stop) {
        try {
          return record(options, own, stop);
        } catch (const std::invalid_argument& error) {
          std::fprintf(stderr, "saphira: %s\n", error.what());
          return static_cast<int>(bus::kExitUsage);
        }
      });
}
