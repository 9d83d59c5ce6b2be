# cmake -DOUT=file.cpp -DIN=schema.json -P embed.cmake: the schema of the contract in the program.
file(READ ${IN} hex HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
file(WRITE ${OUT} "// Made by embed.cmake.
#include \"saphira/viewer/schema.hpp\"

namespace saphira::viewer {
namespace {
constexpr unsigned char bytes[] = {${bytes}};
}  // namespace

std::string_view contract() {
  return {reinterpret_cast<const char*>(bytes), sizeof bytes};
}

}  // namespace saphira::viewer
")
