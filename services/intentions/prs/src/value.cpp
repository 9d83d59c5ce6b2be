#include "saphira/intentions/value.hpp"

#include <algorithm>
#include <utility>

#include "language/reader.hpp"
#include "saphira/base/archive.hpp"
#include "saphira/base/numbers.hpp"
#include "saphira/base/text.hpp"

namespace saphira::intentions {
namespace {

const char* name_of(Frame frame) {
  return frame == Frame::robot ? "robot" : frame == Frame::odom ? "odom" : "map";
}

constexpr std::pair<Reference::Kind, const char*> kKinds[] = {
    {Reference::Kind::kRegion, "region"},
    {Reference::Kind::kLink, "link"},
    {Reference::Kind::kArtifact, "artifact"},
    {Reference::Kind::kPercept, "percept"},
    {Reference::Kind::kThing, "thing"}};

const char* name_of(Reference::Kind kind) {
  for (const auto& [each, name] : kKinds) {
    if (each == kind)
      return name;
  }
  return "?";
}

/// True where a text without quotes reads back as itself.
bool is_name(const std::string& text) {
  if (text.empty() || text == "t" || text == "nil" || text == "." || text.front() == ':' ||
      text.front() == '+' || text.front() == '-' || text.front() == '.' ||
      (text.front() >= '0' && text.front() <= '9'))
    return false;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '*' || c == '.' || c == '/';
    if (!plain)
      return false;
  }
  return normal(text) != "t" && normal(text) != "nil";
}

std::string in_quotes(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      result += '\\';
    result += byte < 0x20 || byte == 0x7f ? ' ' : c;
  }
  return result + '"';
}

Value value_of_form(const Form& form) {
  if (!form.is_list())
    return literal(form);
  const auto& items = form.items;
  if (!items.empty() && items[0].kind == Form::Kind::kName) {
    const auto numbers = [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        if (items[i].kind != Form::Kind::kNumber)
          return false;
      }
      return true;
    };
    if (items[0].is("point") && items.size() == 5 && numbers(1, 4)) {
      Point point{{items[1].number, items[2].number, items[3].number}, Frame::odom};
      for (const Frame frame : {Frame::robot, Frame::odom, Frame::map}) {
        if (items[4].is(name_of(frame)))
          point.frame = frame;
      }
      return Value(point);
    }
    for (const auto& [kind, name] : kKinds) {
      const auto whole = [&](std::size_t i) {
        return items[i].number >= 0.0 && items[i].number < 9e15;
      };
      if (items[0].is(name) && items.size() == 3 && numbers(1, 3) && whole(1) && whole(2))
        return Value(Reference{kind, static_cast<std::uint64_t>(items[1].number),
                               static_cast<std::uint64_t>(items[2].number)});
    }
  }
  Value::List list;
  for (const Form& item : items)
    list.push_back(value_of_form(item));
  return Value(std::move(list));
}

std::string print(const Value& value, bool speak) {
  if (value.nil())
    return "nil";
  if (value.is_t())
    return "t";
  if (const double* const number = value.number())
    return speak ? plain(*number) : exact(*number);
  if (const std::string* const text = value.text())
    return speak || is_name(*text) ? *text : in_quotes(*text);
  if (const Point* const point = value.point()) {
    if (speak)
      return "(" + plain(point->pose.x) + ", " + plain(point->pose.y) + ") in " +
             name_of(point->frame);
    return "(point " + exact(point->pose.x) + " " + exact(point->pose.y) + " " +
           exact(point->pose.th) + " :" + name_of(point->frame) + ")";
  }
  if (const Reference* const reference = value.reference())
    return speak
               ? std::string(name_of(reference->kind)) + " " + std::to_string(reference->id)
               : "(" + std::string(name_of(reference->kind)) + " " + std::to_string(reference->id) +
                     " " + std::to_string(reference->revision) + ")";
  std::string result = speak ? "" : "(";
  bool first = true;
  for (const Value& each : value.list()) {
    if (!std::exchange(first, false))
      result += speak ? ", " : " ";
    result += print(each, speak);
  }
  return speak ? result : result + ")";
}

}  // namespace

struct Value::Elements {
  List list;
  std::size_t weight = 1;
};

Value::Value(List list) {
  if (list.empty())
    return;
  std::size_t weight = 1;
  for (const Value& each : list)
    weight = std::min(weight + each.weight(), std::size_t{1} << 40);
  is_ = std::make_shared<const Elements>(Elements{std::move(list), weight});
}

std::size_t Value::weight() const {
  const auto* const elements = std::get_if<std::shared_ptr<const Elements>>(&is_);
  return elements == nullptr ? 1 : (*elements)->weight;
}

Value Value::truth(bool yes) {
  Value value;
  if (yes)
    value.is_ = true;
  return value;
}

const Value::List& Value::list() const {
  static const List none;
  const auto* const elements = std::get_if<std::shared_ptr<const Elements>>(&is_);
  return elements == nullptr ? none : (*elements)->list;
}

bool Value::operator==(const Value& other) const {
  if (is_list() && other.is_list())
    return list() == other.list();
  return is_ == other.is_;
}

void Value::archive(Archive& a) {
  a.item(is_);
}

std::string to_text(const Value& value) {
  return print(value, false);
}

std::string spoken(const Value& value) {
  return print(value, true);
}

std::string kind_of(const Value& value) {
  if (value.nil())
    return "nil";
  if (value.is_t())
    return "t";
  if (value.number() != nullptr)
    return "a number";
  if (value.text() != nullptr)
    return "the text " + quoted(*value.text());
  if (value.point() != nullptr)
    return "a point";
  if (value.reference() != nullptr)
    return std::string("a ") + name_of(value.reference()->kind);
  return "a list";
}

Value parse_value(std::string_view text, const std::string& source) {
  std::vector<Diagnostic> troubles;
  Reader reader(source, text, troubles);
  const std::vector<Form> forms = reader.read();
  if (troubles.empty() && forms.size() != 1)
    troubles.push_back(
        reader.trouble(1, 1, true, forms.empty() ? "expected a value" : "expected one value only"));
  if (!troubles.empty()) {
    const Diagnostic& first = troubles.front();
    throw FileError(first.file, first.line, first.column, first.message, first.line_text);
  }
  return value_of_form(forms.front());
}

Value value_of(const Argument& argument) {
  switch (argument.kind) {
    case ArgumentKind::number:
      return Value(argument.number);
    case ArgumentKind::text:
      return Value(argument.text);
    case ArgumentKind::point:
      return Value(Point{argument.point, argument.frame});
    case ArgumentKind::truth:
      return Value::truth(argument.number != 0.0);
    case ArgumentKind::unbound:
      break;
  }
  return {};
}

bool to_argument(const std::string& name, const Value& value, Argument& argument) {
  if (const double* const as_number = value.number())
    argument = number(name, *as_number);
  else if (const std::string* const as_text = value.text())
    argument = text(name, *as_text);
  else if (const Point* const as_point = value.point())
    argument = point(name, as_point->pose, as_point->frame);
  else
    return false;
  return true;
}

}  // namespace saphira::intentions
