// Messages of a viewer: each is taken or refused, and the samples that wait stay bounded.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "saphira/viewer/protocol.hpp"

using namespace saphira::viewer;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<Channel> channels{{"a", "A", "{}"}, {"b", "B", "{}"}};
  Client client("robot", channels, 200);
  const auto added = client.take({reinterpret_cast<const char*>(data), size});
  for (const std::size_t channel : added.value_or(std::vector<std::size_t>{}))
    if (channel >= channels.size())
      std::abort();
  for (int i = 0; i < 20; ++i)
    client.offer(0, i, "{\"number\":1}");
  std::size_t waiting = 0;
  while (const auto frame = client.next())
    waiting += frame->binary ? frame->content.size() : 0;
  if (waiting > 200)
    std::abort();
  return 0;
}
