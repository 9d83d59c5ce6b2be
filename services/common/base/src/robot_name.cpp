#include "saphira/base/robot_name.hpp"

namespace saphira {

std::string trouble_of_robot(const std::string& name) {
  constexpr std::size_t kMostLetters = 64;
  const bool is_name =
      !name.empty() && name.size() <= kMostLetters &&
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.") ==
          std::string::npos;
  return is_name
             ? std::string()
             : "expected the name of one robot (1 to 64 letters, digits, -, _ and .), found \"" +
                   name + "\"";
}

}  // namespace saphira
