#include "saphira/security/seal.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace saphira::security {
namespace {

using Bytes = std::vector<std::uint8_t>;

const std::string kOld(64, 'a');
const std::string kNew(64, 'b');

Bytes message() {
  Bytes bytes{'R', 'T', 'P', 'S'};
  for (std::uint8_t i = 4; i < 120; ++i)
    bytes.push_back(i);
  return bytes;
}
Bytes sealed(const Seal& seal, std::int64_t time = 1'800'000'000) {
  Bytes bytes = message();
  seal.close(bytes, time);
  return bytes;
}
Seal::Opened opened(const Seal& seal, const Bytes& bytes) {
  return seal.open(bytes.data(), bytes.size());
}

TEST(Seal, ShowsThatTheSenderKnowsTheKeyAndWhen) {
  const Seal seal({kOld});
  const auto found = opened(seal, sealed(seal));
  EXPECT_EQ(found.size, message().size());
  EXPECT_EQ(found.sealed, 1'800'000'000);
  EXPECT_EQ(sealed(seal).size() % 4, 0U);
}

TEST(Seal, EachChangeShows) {
  const Seal seal({kOld});
  const Bytes whole = sealed(seal);
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      Bytes changed = whole;
      changed[at] = static_cast<std::uint8_t>(changed[at] ^ (1U << static_cast<unsigned>(bit)));
      EXPECT_EQ(opened(seal, changed).sealed, std::nullopt) << at << " " << bit;
    }
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(seal.open(whole.data(), size).sealed, std::nullopt) << size;
}

TEST(Seal, WithoutOneAMessageIsAsItWas) {
  const Seal seal({kOld});
  EXPECT_EQ(opened(seal, message()).size, message().size());
  EXPECT_EQ(opened(seal, message()).sealed, std::nullopt);
  EXPECT_EQ(opened(Seal({kNew}), sealed(seal)).sealed, std::nullopt) << "of another site";
  const Seal none({});
  EXPECT_EQ(sealed(none), message());
  const auto found = opened(none, sealed(seal));
  EXPECT_EQ(found.size, message().size()) << "a seal is no part of the message";
  EXPECT_EQ(found.sealed, std::nullopt);
}

TEST(Seal, DuringAChangeOfKeysOldAndNewKnowEachOther) {
  const Seal old({kOld});
  const Seal both({kNew, kOld});
  const Seal fresh({kNew});
  for (const Seal* const one : {&old, &both, &fresh})
    for (const Seal* const other : {&old, &both, &fresh}) {
      const bool share = one == other || one == &both || other == &both;
      EXPECT_EQ(opened(*other, sealed(*one)).sealed.has_value(), share);
    }
}

TEST(Seal, KeysAreReadFromAFile) {
  const std::string key = new_site_key();
  EXPECT_NE(key, new_site_key());
  EXPECT_EQ(parse_site_keys(site_keys_text({key, kOld})), (std::vector{key, kOld}));
  for (const std::string& text :
       {std::string(), std::string("abc\n"), key + " " + key + "\n", key + "\n" + key + "\n" + key})
    EXPECT_THROW(parse_site_keys(text), std::runtime_error) << text;
}

}  // namespace
}  // namespace saphira::security
