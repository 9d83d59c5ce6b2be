#include <algorithm>
#include <array>

#include "c_parser.hpp"
#include "saphira/base/enumerators.hpp"

namespace saphira::behaviors::language {
namespace {

constexpr std::size_t kMostRules = 64;       // the bound of BehaviorState.rules on the bus
constexpr std::size_t kMostParameters = 16;  // the bound of BehaviorSchema.parameters

bool parameter_type(std::string_view word) {
  return word == "sfINT" || word == "sfFLOAT" || word == "sfPTR" || word == "sfTEXT";
}

bool fuzzy_keyword(std::string_view word) {
  constexpr std::array keywords{"If", "Then", "Not", "And", "Or", "Turn", "Left", "Right", "Speed"};
  return std::find(keywords.begin(), keywords.end(), word) != keywords.end();
}

struct Unit {
  std::string_view inside;
  const char* outside;
  double factor;  ///< from outside to inside
};
constexpr Unit kUnits[] = {{"mm", "m", 1000.0},
                           {"rad", "rad", 1.0},
                           {"deg", "rad", 180.0 / kPi},
                           {"s", "s", 1.0},
                           {"cycles", "cycles", 1.0}};

class Parser {
 public:
  Parser(const std::vector<Token>& tokens, Messages& messages)
      : cursor_(tokens), messages_(messages) {}

  std::vector<ParsedBehavior> all() {
    std::vector<ParsedBehavior> behaviors;
    while (!cursor_.at_end() && !messages_.full()) {
      if (!cursor_.now().is("BeginBehavior")) {
        messages_.error(cursor_.now().place,
                        "expected \"BeginBehavior\", found " + found(cursor_.now()));
        while (!cursor_.at_end() && !cursor_.now().is("BeginBehavior"))
          cursor_.skip();
        continue;
      }
      behaviors.push_back(behavior());
    }
    return behaviors;
  }

 private:
  void report(const SyntaxError& error) { messages_.error(error.place, error.message); }

  /// Reads sentences until the section ends. After an unreadable one, continues where `begins`
  /// finds the next.
  template <class Sentence, class Begins>
  void section(Sentence&& sentence, Begins&& begins) {
    while (!cursor_.at_end() && !ends_section(cursor_.now()) && !messages_.full()) {
      const std::size_t before = cursor_.place();
      c_.naming().clear();
      try {
        sentence();
      } catch (const SyntaxError& error) {
        report(error);
        lost_.insert(lost_.end(), c_.naming().begin(), c_.naming().end());
        if (cursor_.place() == before)
          cursor_.skip();
        while (!cursor_.at_end() && !ends_section(cursor_.now()) && !begins())
          cursor_.skip();
      }
    }
  }

  ParsedBehavior behavior() {
    ParsedBehavior out;
    cursor_.take();
    out.place = cursor_.now().place;
    try {
      out.name = std::string(cursor_.expect_symbol("the name of the behavior").text);
      if (cursor_.now().kind == TokenKind::text)
        out.summary = std::string(cursor_.take().text);
      if (!ends_section(cursor_.now()))
        cursor_.expected("\"Params\"");
    } catch (const SyntaxError& error) {
      report(error);
      while (!cursor_.at_end() && !ends_section(cursor_.now()))
        cursor_.skip();
    }
    head("Params", true);
    section([&] { parameter(out); }, [&] { return parameter_type(cursor_.now().text); });
    head("Rules", true);
    section([&] { rule(out); }, [&] { return cursor_.now().is("If"); });
    if (head("Init", false))
      section([&] { out.init.push_back(c_.statement()); }, [&] { return c_.after_statement(); });
    head("Update", true);
    section([&] { out.update.push_back(c_.statement()); }, [&] { return c_.after_statement(); });
    head("Activity", true);
    section([&] { activity(out); },
            [&] { return channel(cursor_.now().text) && cursor_.now().kind == TokenKind::symbol; });
    if (!cursor_.accept("EndBehavior"))
      messages_.error(cursor_.now().place,
                      "expected \"EndBehavior\", found " + found(cursor_.now()));
    out.lost = std::move(lost_);
    lost_.clear();
    return out;
  }

  /// The word that begins a section. Without it the section counts as empty.
  bool head(std::string_view word, bool required) {
    if (cursor_.accept(word))
      return true;
    if (required && !messages_.full())
      messages_.error(cursor_.now().place,
                      "expected \"" + std::string(word) + "\", found " + found(cursor_.now()));
    return false;
  }

  // Params --------------------------------------------------------------------------------------

  void parameter(ParsedBehavior& out) {
    ParsedParameter parameter;
    if (!parameter_type(cursor_.now().text))
      cursor_.expected("\"sfINT\", \"sfFLOAT\", \"sfPTR\" or \"sfTEXT\"");
    const std::string_view type = cursor_.take().text;
    parameter.type = type == "sfINT"    ? Type::integer
                     : type == "sfPTR"  ? Type::point
                     : type == "sfTEXT" ? Type::text
                                        : Type::real;
    parameter.place = cursor_.now().place;
    ParameterSpec& spec = parameter.spec;
    spec.name = std::string(cursor_.expect_symbol("the name of the parameter").text);
    c_.naming().push_back(spec.name);
    // An underscore lost in print.
    while (cursor_.now().kind == TokenKind::symbol && !ends_section(cursor_.now()) &&
           !parameter_type(cursor_.now().text) && !cursor_.now().is("from") &&
           !cursor_.now().is("optional") && !is_unit()) {
      spec.name += "_" + std::string(cursor_.now().text);
      messages_.warn(cursor_.now().place, "two names in a row are taken for \"" + spec.name + "\"");
      cursor_.take();
    }
    spec.kind = parameter.type == Type::point  ? Kind::point
                : parameter.type == Type::text ? Kind::text
                                               : Kind::number;
    spec.required = true;
    if (parameter.type == Type::text)
      choices(spec);
    else if (parameter.type == Type::point)
      spec.required = !cursor_.accept("optional");
    else
      number(parameter);
    if (cursor_.now().kind == TokenKind::text)
      spec.meaning += (spec.meaning.empty() ? "" : ", ") + std::string(cursor_.take().text);
    if (out.parameters.size() == kMostParameters)
      throw SyntaxError{parameter.place,
                        "expected at most " + std::to_string(kMostParameters) + " parameters"};
    out.parameters.push_back(std::move(parameter));
  }

  void choices(ParameterSpec& spec) {
    spec.required = false;
    cursor_.expect("=");
    do {
      if (cursor_.now().kind != TokenKind::text)
        cursor_.expected("a choice, such as \"left\"");
      spec.choices.emplace_back(cursor_.take().text);
    } while (cursor_.accept("|"));
  }

  bool is_unit() const {
    return cursor_.now().kind == TokenKind::symbol &&
           std::any_of(std::begin(kUnits), std::end(kUnits),
                       [&](const Unit& unit) { return unit.inside == cursor_.now().text; });
  }

  /// [= usual] [from low to high] [unit]
  void number(ParsedParameter& parameter) {
    ParameterSpec& spec = parameter.spec;
    spec.low = -1e9;
    spec.high = 1e9;
    const Place place = cursor_.now().place;
    if (cursor_.accept("=")) {
      spec.usual = cursor_.expect_number("the usual value");
      spec.required = false;
    }
    if (cursor_.accept("from")) {
      spec.low = cursor_.expect_number("the lowest value");
      cursor_.expect("to");
      spec.high = cursor_.expect_number("the highest value");
      if (spec.low > spec.high)
        throw SyntaxError{place, "expected the lower limit before the higher one"};
    }
    if (!spec.required && (spec.usual < spec.low || spec.usual > spec.high))
      throw SyntaxError{place, "expected a usual value within the limits"};
    if (is_unit()) {
      const std::string_view name = cursor_.take().text;
      const Unit& unit = *std::find_if(std::begin(kUnits), std::end(kUnits),
                                       [&](const Unit& u) { return u.inside == name; });
      parameter.factor = unit.factor;
      spec.meaning = unit.outside;
      if (cursor_.accept("/")) {
        if (!cursor_.accept("s"))
          cursor_.expected("\"s\"");
        spec.meaning += "/s";
      }
    }
    for (double* const value : {&spec.usual, &spec.low, &spec.high})
      *value /= parameter.factor;
  }

  // Rules ---------------------------------------------------------------------------------------

  void rule(ParsedBehavior& out) {
    ParsedRule rule;
    rule.place = cursor_.now().place;
    rule.name = "rule_" + std::to_string(out.rules.size() + 1);
    if ((cursor_.now().kind == TokenKind::symbol && !cursor_.now().is("If")) ||
        cursor_.now().kind == TokenKind::text) {
      rule.name = std::string(cursor_.take().text);
      if (!cursor_.now().is("If"))
        cursor_.expected("\"If\" after the name of a rule");
    }
    cursor_.expect("If");
    const std::size_t begin = cursor_.place();
    rule.antecedent = either(0);
    rule.antecedent_text = cursor_.words(begin, cursor_.place());
    if (!cursor_.now().is("Then"))
      cursor_.expected("\"Then\", \"And\" or \"Or\"");
    cursor_.take();
    control(out, std::move(rule));
  }

  void control(ParsedBehavior& out, ParsedRule rule) {
    const std::size_t begin = cursor_.place();
    if (cursor_.accept("Turn")) {
      if (cursor_.accept("Left")) {
        rule.kind = ParsedRule::Kind::left;
      } else if (cursor_.accept("Right")) {
        rule.kind = ParsedRule::Kind::right;
      } else {
        if (cursor_.now().kind != TokenKind::symbol || fuzzy_keyword(cursor_.now().text) ||
            ends_section(cursor_.now()))
          cursor_.expected("\"Left\", \"Right\" or a variable");
        rule.kind = ParsedRule::Kind::either;
        rule.value = value("a variable");
      }
      rule.modifier = modifier();
      rule.action_text = cursor_.words(begin, cursor_.place());
      // The printed grammar allows a turn and a speed after one antecedent.
      const bool both = cursor_.now().is("Speed");
      ParsedRule second = rule;
      push(out, std::move(rule));
      if (!both)
        return;
      second.name += "_speed";
      second.value.reset();
      second.modifier.reset();
      speed(out, std::move(second));
      return;
    }
    speed(out, std::move(rule));
  }

  void speed(ParsedBehavior& out, ParsedRule rule) {
    const std::size_t begin = cursor_.place();
    if (cursor_.accept("Speed"))
      rule.kind = ParsedRule::Kind::speed;
    else if (cursor_.accept("Accel"))
      rule.kind = ParsedRule::Kind::accelerate;
    else if (cursor_.accept("Decel"))
      rule.kind = ParsedRule::Kind::decelerate;
    else
      cursor_.expected("\"Turn\", \"Speed\", \"Accel\" or \"Decel\"");
    rule.value = value("a variable or a number");
    rule.action_text = cursor_.words(begin, cursor_.place());
    push(out, std::move(rule));
  }

  void push(ParsedBehavior& out, ParsedRule rule) {
    if (out.rules.size() == kMostRules)
      throw SyntaxError{rule.place, "expected at most " + std::to_string(kMostRules) + " rules"};
    out.rules.push_back(std::move(rule));
  }

  RuleValue value(const std::string& what) {
    RuleValue value;
    value.place = cursor_.now().place;
    if (cursor_.now().kind == TokenKind::symbol && !fuzzy_keyword(cursor_.now().text) &&
        !ends_section(cursor_.now()))
      value.name = std::string(cursor_.take().text);
    else
      value.value = cursor_.expect_number(what);
    return value;
  }

  std::optional<RuleValue> modifier() {
    // [rad]; the manual's Figure 2-6 shows 5 degrees for a gentle turn.
    struct Named {
      std::string_view first;
      std::string_view second;
      double degrees;
    };
    constexpr Named modifiers[] = {{"Very", "Slowly", 2.5},
                                   {"Very", "Sharply", 40.0},
                                   {"Slowly", "", 5.0},
                                   {"Moderately", "", 10.0},
                                   {"Sharply", "", 20.0}};
    RuleValue out;
    out.place = cursor_.now().place;
    for (const Named& named : modifiers)
      if (cursor_.now().is(named.first) &&
          (named.second.empty() || cursor_.ahead(1).is(named.second))) {
        cursor_.skip(named.second.empty() ? 1 : 2);
        out.value = radians(named.degrees);
        return out;
      }
    if (cursor_.now().is("Very")) {
      cursor_.take();
      cursor_.expected("\"Slowly\" or \"Sharply\"");
    }
    // Another symbol is a variable, unless it is the name of the next rule.
    if (cursor_.now().kind != TokenKind::symbol || fuzzy_keyword(cursor_.now().text) ||
        ends_section(cursor_.now()) || cursor_.now().is("Accel") || cursor_.now().is("Decel") ||
        cursor_.ahead(1).is("If"))
      return {};
    out.name = std::string(cursor_.take().text);
    return out;
  }

  // Fuzzy expressions ---------------------------------------------------------------------------

  FuzzyExpression either(int depth) {
    FuzzyExpression left = both(depth);
    while (cursor_.now().is("Or"))
      left = joined(FuzzyExpression::Kind::either, std::move(left), [&] { return both(depth); });
    return left;
  }

  FuzzyExpression both(int depth) {
    FuzzyExpression left = inverted(depth);
    while (cursor_.now().is("And"))
      left = joined(FuzzyExpression::Kind::both, std::move(left), [&] { return inverted(depth); });
    return left;
  }

  template <class Next>
  FuzzyExpression joined(FuzzyExpression::Kind kind, FuzzyExpression left, Next&& next) {
    FuzzyExpression out;
    out.kind = kind;
    out.place = cursor_.take().place;
    FuzzyExpression right = next();
    out.depth = 1 + std::max(left.depth, right.depth);
    limit_depth(out.depth, out.place);
    out.parts.push_back(std::move(left));
    out.parts.push_back(std::move(right));
    return out;
  }

  FuzzyExpression inverted(int depth) {
    limit_depth(depth, cursor_.now().place);
    FuzzyExpression out;
    out.place = cursor_.now().place;
    if (cursor_.accept("Not")) {
      out.kind = FuzzyExpression::Kind::invert;
      out.parts.push_back(inverted(depth + 1));
      out.depth = 1 + out.parts.front().depth;
      return out;
    }
    if (cursor_.accept("(")) {
      out = either(depth + 1);
      if (!cursor_.now().is(")"))
        cursor_.expected("\")\", \"And\" or \"Or\"");
      cursor_.take();
      return out;
    }
    if (cursor_.now().kind == TokenKind::number) {
      out.value = cursor_.take().value;
      if (out.value < 0.0 || out.value > 1.0)
        throw SyntaxError{out.place, "expected a fuzzy value from 0 to 1"};
      return out;
    }
    if (cursor_.now().kind != TokenKind::symbol || fuzzy_keyword(cursor_.now().text) ||
        ends_section(cursor_.now()))
      cursor_.expected("a fuzzy variable, a number from 0 to 1, \"Not\" or \"(\"");
    out.kind = FuzzyExpression::Kind::name;
    out.name = std::string(cursor_.take().text);
    // An underscore lost in print. The next sentence begins with a keyword, or in the rules with
    // the name of a rule, followed by "If".
    while (cursor_.now().kind == TokenKind::symbol && !fuzzy_keyword(cursor_.now().text) &&
           !channel(cursor_.now().text) && !ends_section(cursor_.now()) &&
           !cursor_.ahead(1).is("If")) {
      out.name += "_" + std::string(cursor_.now().text);
      messages_.warn(cursor_.now().place, "two names in a row are taken for \"" + out.name + "\"");
      cursor_.take();
    }
    return out;
  }

  // Activity ------------------------------------------------------------------------------------

  static bool channel(std::string_view word) {
    return word == "Turn" || word == "Speed" || word == "Goal" || word == "Progress";
  }

  void activity(ParsedBehavior& out) {
    ParsedActivity activity;
    activity.place = cursor_.now().place;
    if (cursor_.now().kind != TokenKind::symbol || !channel(cursor_.now().text))
      cursor_.expected("\"Turn\", \"Speed\", \"Goal\" or \"Progress\"");
    activity.channel = std::string(cursor_.take().text);
    for (const ParsedActivity& other : out.activity)
      if (other.channel == activity.channel)
        throw SyntaxError{activity.place, "\"" + activity.channel + "\" is there twice"};
    activity.value = either(0);
    out.activity.push_back(std::move(activity));
  }

  Cursor cursor_;
  Messages& messages_;
  CParser c_{cursor_};
  std::vector<std::string> lost_;  ///< of unreadable sentences
};

}  // namespace

std::string named(Type type) {
  return word_of(type, {"nothing", "a number", "a number", "a point", "a text"});
}

std::vector<ParsedBehavior> parse(const std::vector<Token>& tokens, Messages& messages) {
  return Parser(tokens, messages).all();
}

}  // namespace saphira::behaviors::language
