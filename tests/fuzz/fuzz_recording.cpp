// A recording of the bus: its samples are read, or it gives an error that says where. What was read
// is the same when it is written and read again.

#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "fuzz.hpp"
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

void saphira::fuzz::run(std::string_view text) {
  const std::string file(text);
  try {
    std::string written;
    const Read samples = read(file, &written);
    require(read(written, nullptr) == samples);
  } catch (const std::invalid_argument& error) {
    const std::string_view why = error.what();
    require(why.starts_with("byte ") || why.starts_with("not an MCAP file"));
  }
}
