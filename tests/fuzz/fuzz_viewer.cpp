// Messages of a viewer: each is taken or refused, and the samples that wait stay bounded.

#include <string>

#include "fuzz.hpp"
#include "saphira/viewer/protocol.hpp"

using namespace saphira::viewer;

void saphira::fuzz::run(std::string_view text) {
  static const std::vector<Channel> channels{{"a", "A", "{}"}, {"b", "B", "{}"}};
  Client client("robot", channels, 200);
  const auto added = client.take(std::string(text));
  for (const std::size_t channel : added.value_or(std::vector<std::size_t>{}))
    require(channel < channels.size());
  for (int i = 0; i < 20; ++i)
    client.offer(0, i, "{\"number\":1}");
  std::size_t waiting = 0;
  while (const auto frame = client.next())
    waiting += frame->binary ? frame->content.size() : 0;
  require(waiting <= 200);
}
