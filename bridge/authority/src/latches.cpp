#include "saphira/authority/latches.hpp"

#include <sstream>

namespace saphira::authority {

namespace {

const char* word(Wait wait) {
  switch (wait) {
    case Wait::driven:
      return "driven";
    case Wait::reset:
      return "reset";
    case Wait::none:
      break;
  }
  return "none";
}

}  // namespace

std::string to_text(const Latches& latches) {
  if (latches == Latches{})
    return {};
  std::string source = latches.estop_source;
  for (char& c : source)
    c = c == '\n' || c == '\r' ? ' ' : c;
  return std::string("wait ") + word(latches.wait) +
         (latches.estopped ? " estop by " + source : " end") + "\n";
}

Latches latches_from_text(const std::string& text) {
  if (text.empty())
    return {};
  Latches out;
  std::istringstream in(text);
  std::string key;
  std::string wait;
  std::string what;
  in >> key >> wait >> what;
  bool known = key == "wait" && text.back() == '\n';
  known = known && (wait == "none" || wait == "driven" || wait == "reset");
  known = known && (what == "end" || what == "estop");
  if (!known)
    return {true, "nobody known: what was kept of it cannot be read", Wait::driven};
  out.wait = wait == "driven" ? Wait::driven : wait == "reset" ? Wait::reset : Wait::none;
  if (what == "estop") {
    out.estopped = true;
    in >> key;  // by
    std::getline(in >> std::ws, out.estop_source);
  }
  return out;
}

}  // namespace saphira::authority
