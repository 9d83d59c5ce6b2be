// A recording of the bus: its samples are read, or it gives an error that says where. What was read
// is the same when it is written and read again.

#include <cstdint>
#include <cstdlib>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "saphira/recorder/recording.hpp"

using namespace saphira::recorder;

namespace {

using Read = std::vector<std::pair<std::string, std::string>>;  // topic and JSON

Read read(const std::string& file, std::string* written) {
  std::istringstream in(file);
  std::ostringstream out;
  Reader reader(in);
  Writer writer(out);
  std::map<std::string, std::uint16_t> channels;
  Read samples;
  while (const auto sample = reader.next()) {
    const Channel& channel = reader.channel(sample->channel);
    if (!channels.contains(channel.topic))
      channels[channel.topic] = writer.add_channel(channel, "{}");
    samples.emplace_back(channel.topic, sample->json);
    writer.add({channels[channel.topic], sample->time_ns, sample->json});
  }
  writer.close();
  if (written != nullptr)
    *written = out.str();
  return samples;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file(reinterpret_cast<const char*>(data), size);
  try {
    std::string written;
    const Read samples = read(file, &written);
    if (read(written, nullptr) != samples)
      std::abort();
  } catch (const std::invalid_argument& error) {
    const std::string_view text = error.what();
    if (!text.starts_with("byte ") && !text.starts_with("not an MCAP file"))
      std::abort();
  }
  return 0;
}
