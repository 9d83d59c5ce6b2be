#include "saphira/requests/argument.hpp"

#include "saphira/base/enumerators.hpp"
#include "saphira/base/numbers.hpp"

namespace saphira {

Argument number(std::string name, double value) {
  return {std::move(name), value};
}

Argument text(std::string name, std::string value) {
  return {std::move(name), std::move(value)};
}

Argument point(std::string name, const Pose& value, Frame frame) {
  return {std::move(name), PlacedPoint{value, frame}};
}

Argument truth(std::string name, bool value) {
  return {std::move(name), value};
}

const Argument* find(const Arguments& arguments, std::string_view name) {
  for (const Argument& argument : arguments)
    if (argument.name == name)
      return &argument;
  return nullptr;
}

double number_of(const Arguments& arguments, std::string_view name) {
  const Argument* const found = find(arguments, name);
  return found == nullptr ? 0.0 : found->number;
}

bool truth_of(const Arguments& arguments, std::string_view name) {
  return number_of(arguments, name) != 0.0;
}

const std::string& text_of(const Arguments& arguments, std::string_view name) {
  static const std::string none;
  const Argument* const found = find(arguments, name);
  return found == nullptr ? none : found->text;
}

Pose point_of(const Arguments& arguments, std::string_view name) {
  const Argument* const found = find(arguments, name);
  return found == nullptr ? Pose{} : found->point;
}

std::vector<double> numbers_of(const Arguments& arguments, std::string_view name) {
  std::vector<double> numbers;
  for (const Argument& argument : arguments)
    if (argument.name == name)
      numbers.push_back(argument.number);
  return numbers;
}

std::string describe(const Arguments& arguments) {
  std::string words;
  for (const Argument& argument : arguments) {
    words += (words.empty() ? "" : " ") + argument.name.substr(0, 40) + "=";
    switch (argument.kind) {
      case ArgumentKind::number:
        words += plain(argument.number);
        break;
      case ArgumentKind::text:
        words += quoted(argument.text);
        break;
      case ArgumentKind::point:
        words += "(" + plain(argument.point.x) + ", " + plain(argument.point.y) + ", " +
                 plain(argument.point.th) + ")";
        break;
      case ArgumentKind::truth:
        words += argument.number != 0.0 ? "yes" : "no";
        break;
      case ArgumentKind::unbound:
        words += "?";
        break;
    }
  }
  return words;
}

const char* describe(ArgumentKind kind) {
  return word_of(kind, {"a number", "a text", "a point", "yes or no", "nothing"});
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "\"";
  for (const char c : text.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    result += byte < 0x20 || byte == 0x7f ? '?' : c;
  }
  return result + (text.size() > longest ? "...\"" : "\"");
}

}  // namespace saphira
