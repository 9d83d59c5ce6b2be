# cmake -DOUT=file.cpp -DFOLDER=built -P embed.cmake: the page's files as bytes of a source file.
set(bytes)
set(list)
foreach(file index.html simulator.html manifest.json icon.svg)
  file(READ ${FOLDER}/${file} hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," hex "${hex}")
  string(MAKE_C_IDENTIFIER ${file} name)
  string(APPEND bytes "constexpr unsigned char ${name}[] = {${hex}};\n")
  string(APPEND list "      {\"/${file}\", {reinterpret_cast<const char*>(${name}), sizeof ${name}}},\n")
endforeach()
file(WRITE ${OUT} "// Made by embed.cmake.
#include \"server.hpp\"

namespace saphira::console {
namespace {
${bytes}}  // namespace

std::vector<PageFile> page_files() {
  return {
${list}  };
}

}  // namespace saphira::console
")
