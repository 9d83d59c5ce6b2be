#include "saphira/bus/audit.hpp"

#include <gtest/gtest.h>

#include "node_options.hpp"

namespace saphira::bus {
namespace {

using saphira::test::memory_options;

TEST(Audit, WrongKeysAreAllCountedInAnEntryAMinute) {
  const std::shared_ptr<MemoryBus> bus = make_memory_bus();
  Node bridge(memory_options("bridge"), bus);
  Reader<v1::AuditEntry> entries = bridge.reader(topics::kAudit);
  Node door(memory_options("console"), bus);
  Audit audit(door);
  const auto texts = [&] {
    std::vector<std::string> all;
    for (const auto& entry : entries.take()) {
      EXPECT_EQ(entry.data.act, v1::AUDIT_REFUSED);
      EXPECT_EQ(entry.data.who, "somebody at the console");
      all.push_back(entry.data.text);
    }
    return all;
  };
  audit.wrong_key("the console", 100.0);
  EXPECT_EQ(texts(), std::vector<std::string>{"1 wrong key"});
  for (int i = 0; i < 500; ++i)
    audit.wrong_key("the console", 101.0);
  audit.wrong_key("the console", 102.0, "anna");
  audit.tend(159.0);
  EXPECT_EQ(texts().size(), 0U);
  audit.tend(160.0);
  EXPECT_EQ(texts(),
            std::vector<std::string>{"501 wrong keys, with that of anna, which has ended"});
  audit.tend(300.0);
  EXPECT_EQ(texts().size(), 0U);
}

}  // namespace
}  // namespace saphira::bus
