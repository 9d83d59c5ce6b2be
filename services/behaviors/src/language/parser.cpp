#include <algorithm>
#include <array>
#include <cmath>

#include "ast.hpp"

namespace saphira::behaviors::language {
namespace {

constexpr int kDeepest = 100;
constexpr std::size_t kMostRules = 64;       // the bound of BehaviorState.rules on the bus
constexpr std::size_t kMostParameters = 16;  // the bound of BehaviorSchema.parameters

/// Thrown where a sentence cannot be read on; caught where the next one begins.
struct SyntaxError {
  Place place;
  std::string message;
};

bool names_type(std::string_view word) {
  return word == "int" || word == "float" || word == "double" || word == "point";
}

bool parameter_type(std::string_view word) {
  return word == "sfINT" || word == "sfFLOAT" || word == "sfPTR" || word == "sfTEXT";
}

/// Words that end a section of the language, wherever they are.
bool ends_section(const Token& token) {
  constexpr std::array keywords{"BeginBehavior", "Params",   "Rules",      "Init",
                                "Update",        "Activity", "EndBehavior"};
  return token.kind == TokenKind::symbol &&
         std::find(keywords.begin(), keywords.end(), token.text) != keywords.end();
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
      : tokens_(tokens), messages_(messages) {}

  std::vector<ParsedBehavior> all() {
    std::vector<ParsedBehavior> behaviors;
    while (!at_end() && !messages_.full()) {
      if (!now().is("BeginBehavior")) {
        messages_.error(now().place, "expected \"BeginBehavior\", found " + found(now()));
        while (!at_end() && !now().is("BeginBehavior"))
          ++at_;
        continue;
      }
      behaviors.push_back(behavior());
    }
    return behaviors;
  }

 private:
  const Token& now() const { return tokens_[at_]; }
  const Token& ahead(std::size_t n) const { return tokens_[std::min(at_ + n, tokens_.size() - 1)]; }
  bool at_end() const { return now().kind == TokenKind::end; }
  const Token& take() {
    const Token& token = now();
    if (!at_end())
      ++at_;
    return token;
  }
  bool accept(std::string_view what) {
    if (!now().is(what))
      return false;
    ++at_;
    return true;
  }
  [[noreturn]] void expected(const std::string& what) const {
    throw SyntaxError{now().place, "expected " + what + ", found " + found(now())};
  }
  void expect(std::string_view what) {
    if (!accept(what))
      expected("\"" + std::string(what) + "\"");
  }
  const Token& expect_symbol(const std::string& what) {
    if (now().kind != TokenKind::symbol || ends_section(now()))
      expected(what);
    return take();
  }
  double expect_number(const std::string& what) {
    const bool negative = accept("-");
    if (now().kind != TokenKind::number)
      expected(what);
    const double value = take().value;
    return negative ? -value : value;
  }
  void report(const SyntaxError& error) { messages_.error(error.place, error.message); }

  /// Reads sentences until the section ends. After one that cannot be read, goes on where
  /// `begins` says that another one does.
  template <class Sentence, class Begins>
  void section(Sentence&& sentence, Begins&& begins) {
    while (!at_end() && !ends_section(now()) && !messages_.full()) {
      const std::size_t before = at_;
      naming_.clear();
      try {
        sentence();
      } catch (const SyntaxError& error) {
        report(error);
        lost_.insert(lost_.end(), naming_.begin(), naming_.end());
        if (at_ == before)
          ++at_;
        while (!at_end() && !ends_section(now()) && !begins())
          ++at_;
      }
    }
  }

  ParsedBehavior behavior() {
    ParsedBehavior out;
    take();
    out.place = now().place;
    try {
      out.name = std::string(expect_symbol("the name of the behavior").text);
      if (now().kind == TokenKind::text)
        out.summary = std::string(take().text);
      if (!ends_section(now()))
        expected("\"Params\"");
    } catch (const SyntaxError& error) {
      report(error);
      while (!at_end() && !ends_section(now()))
        ++at_;
    }
    head("Params", true);
    section([&] { parameter(out); }, [&] { return parameter_type(now().text); });
    head("Rules", true);
    section([&] { rule(out); }, [&] { return now().is("If"); });
    if (head("Init", false))
      section([&] { out.init.push_back(statement()); }, [&] { return after_statement(); });
    head("Update", true);
    section([&] { out.update.push_back(statement()); }, [&] { return after_statement(); });
    head("Activity", true);
    section([&] { activity(out); },
            [&] { return channel(now().text) && now().kind == TokenKind::symbol; });
    if (!accept("EndBehavior"))
      messages_.error(now().place, "expected \"EndBehavior\", found " + found(now()));
    out.lost = std::move(lost_);
    lost_.clear();
    return out;
  }

  /// The word that begins a section. Where it is not there the section is taken to be empty.
  bool head(std::string_view word, bool required) {
    if (accept(word))
      return true;
    if (required && !messages_.full())
      messages_.error(now().place, "expected \"" + std::string(word) + "\", found " + found(now()));
    return false;
  }

  // Params --------------------------------------------------------------------------------------

  void parameter(ParsedBehavior& out) {
    ParsedParameter parameter;
    if (!parameter_type(now().text))
      expected("\"sfINT\", \"sfFLOAT\", \"sfPTR\" or \"sfTEXT\"");
    const std::string_view type = take().text;
    parameter.type = type == "sfINT"    ? Type::integer
                     : type == "sfPTR"  ? Type::point
                     : type == "sfTEXT" ? Type::text
                                        : Type::real;
    parameter.place = now().place;
    ParameterSpec& spec = parameter.spec;
    spec.name = std::string(expect_symbol("the name of the parameter").text);
    naming_.push_back(spec.name);
    // An underscore that the print has lost.
    while (now().kind == TokenKind::symbol && !ends_section(now()) && !parameter_type(now().text) &&
           !now().is("from") && !now().is("optional") && !is_unit()) {
      spec.name += "_" + std::string(now().text);
      messages_.warn(now().place, "two names in a row are taken for \"" + spec.name + "\"");
      take();
    }
    spec.kind = parameter.type == Type::point  ? Kind::point
                : parameter.type == Type::text ? Kind::text
                                               : Kind::number;
    spec.required = true;
    if (parameter.type == Type::text)
      choices(spec);
    else if (parameter.type == Type::point)
      spec.required = !accept("optional");
    else
      number(parameter);
    if (now().kind == TokenKind::text)
      spec.meaning += (spec.meaning.empty() ? "" : ", ") + std::string(take().text);
    if (out.parameters.size() == kMostParameters)
      throw SyntaxError{parameter.place,
                        "expected at most " + std::to_string(kMostParameters) + " parameters"};
    out.parameters.push_back(std::move(parameter));
  }

  void choices(ParameterSpec& spec) {
    spec.required = false;
    expect("=");
    do {
      if (now().kind != TokenKind::text)
        expected("a choice, such as \"left\"");
      spec.choices.emplace_back(take().text);
    } while (accept("|"));
  }

  bool is_unit() const {
    return now().kind == TokenKind::symbol &&
           std::any_of(std::begin(kUnits), std::end(kUnits),
                       [&](const Unit& unit) { return unit.inside == now().text; });
  }

  /// [= usual] [from low to high] [unit]
  void number(ParsedParameter& parameter) {
    ParameterSpec& spec = parameter.spec;
    spec.low = -1e9;
    spec.high = 1e9;
    const Place place = now().place;
    if (accept("=")) {
      spec.usual = expect_number("the usual value");
      spec.required = false;
    }
    if (accept("from")) {
      spec.low = expect_number("the lowest value");
      expect("to");
      spec.high = expect_number("the highest value");
      if (spec.low > spec.high)
        throw SyntaxError{place, "expected the lower limit before the higher one"};
    }
    if (!spec.required && (spec.usual < spec.low || spec.usual > spec.high))
      throw SyntaxError{place, "expected a usual value within the limits"};
    if (is_unit()) {
      const std::string_view name = take().text;
      const Unit& unit = *std::find_if(std::begin(kUnits), std::end(kUnits),
                                       [&](const Unit& u) { return u.inside == name; });
      parameter.factor = unit.factor;
      spec.meaning = unit.outside;
      if (accept("/")) {
        if (!accept("s"))
          expected("\"s\"");
        spec.meaning += "/s";
      }
    }
    for (double* const value : {&spec.usual, &spec.low, &spec.high})
      *value /= parameter.factor;
  }

  // Rules ---------------------------------------------------------------------------------------

  void rule(ParsedBehavior& out) {
    ParsedRule rule;
    rule.place = now().place;
    rule.name = "rule_" + std::to_string(out.rules.size() + 1);
    if ((now().kind == TokenKind::symbol && !now().is("If")) || now().kind == TokenKind::text) {
      rule.name = std::string(take().text);
      if (!now().is("If"))
        expected("\"If\" after the name of a rule");
    }
    expect("If");
    const std::size_t begin = at_;
    rule.antecedent = either(0);
    rule.antecedent_text = words(begin, at_);
    if (!now().is("Then"))
      expected("\"Then\", \"And\" or \"Or\"");
    take();
    control(out, std::move(rule));
  }

  void control(ParsedBehavior& out, ParsedRule rule) {
    const std::size_t begin = at_;
    if (accept("Turn")) {
      if (accept("Left")) {
        rule.kind = ParsedRule::Kind::left;
      } else if (accept("Right")) {
        rule.kind = ParsedRule::Kind::right;
      } else {
        if (now().kind != TokenKind::symbol || fuzzy_keyword(now().text) || ends_section(now()))
          expected("\"Left\", \"Right\" or a variable");
        rule.kind = ParsedRule::Kind::either;
        rule.value = value("a variable");
      }
      rule.modifier = modifier();
      rule.action_text = words(begin, at_);
      // As the grammar is printed, a turn and a speed can follow one antecedent.
      const bool both = now().is("Speed");
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
    const std::size_t begin = at_;
    if (accept("Speed"))
      rule.kind = ParsedRule::Kind::speed;
    else if (accept("Accel"))
      rule.kind = ParsedRule::Kind::accelerate;
    else if (accept("Decel"))
      rule.kind = ParsedRule::Kind::decelerate;
    else
      expected("\"Turn\", \"Speed\", \"Accel\" or \"Decel\"");
    rule.value = value("a variable or a number");
    rule.action_text = words(begin, at_);
    push(out, std::move(rule));
  }

  void push(ParsedBehavior& out, ParsedRule rule) {
    if (out.rules.size() == kMostRules)
      throw SyntaxError{rule.place, "expected at most " + std::to_string(kMostRules) + " rules"};
    out.rules.push_back(std::move(rule));
  }

  RuleValue value(const std::string& what) {
    RuleValue value;
    value.place = now().place;
    if (now().kind == TokenKind::symbol && !fuzzy_keyword(now().text) && !ends_section(now()))
      value.name = std::string(take().text);
    else
      value.value = expect_number(what);
    return value;
  }

  std::optional<RuleValue> modifier() {
    // [rad]; 5 degrees are what the manual's Figure 2-6 shows of a gentle turn.
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
    out.place = now().place;
    for (const Named& named : modifiers)
      if (now().is(named.first) && (named.second.empty() || ahead(1).is(named.second))) {
        at_ += named.second.empty() ? 1 : 2;
        out.value = radians(named.degrees);
        return out;
      }
    if (now().is("Very")) {
      take();
      expected("\"Slowly\" or \"Sharply\"");
    }
    // Another symbol is a variable, unless it is the name of the next rule.
    if (now().kind != TokenKind::symbol || fuzzy_keyword(now().text) || ends_section(now()) ||
        now().is("Accel") || now().is("Decel") || ahead(1).is("If"))
      return {};
    out.name = std::string(take().text);
    return out;
  }

  /// The tokens of a sentence as text.
  std::string words(std::size_t begin, std::size_t end) const {
    std::string out;
    for (std::size_t i = begin; i < end && out.size() < 200; ++i) {
      const Token& token = tokens_[i];
      const bool tight =
          out.empty() || token.is(")") || tokens_[i - 1].is("(") || tokens_[i - 1].is("-");
      out += (tight ? "" : " ") + std::string(token.text);
    }
    return out;
  }

  // Fuzzy expressions ---------------------------------------------------------------------------

  FuzzyExpression either(int depth) {
    FuzzyExpression left = both(depth);
    while (now().is("Or"))
      left = joined(FuzzyExpression::Kind::either, std::move(left), [&] { return both(depth); });
    return left;
  }

  FuzzyExpression both(int depth) {
    FuzzyExpression left = inverted(depth);
    while (now().is("And"))
      left = joined(FuzzyExpression::Kind::both, std::move(left), [&] { return inverted(depth); });
    return left;
  }

  template <class Next>
  FuzzyExpression joined(FuzzyExpression::Kind kind, FuzzyExpression left, Next&& next) {
    FuzzyExpression out;
    out.kind = kind;
    out.place = take().place;
    FuzzyExpression right = next();
    out.depth = 1 + std::max(left.depth, right.depth);
    too_deep(out.depth, out.place);
    out.parts.push_back(std::move(left));
    out.parts.push_back(std::move(right));
    return out;
  }

  static void too_deep(int depth, const Place& place) {
    if (depth > kDeepest)
      throw SyntaxError{place, "expected something simpler: this is more than " +
                                   std::to_string(kDeepest) + " levels deep"};
  }

  FuzzyExpression inverted(int depth) {
    too_deep(depth, now().place);
    FuzzyExpression out;
    out.place = now().place;
    if (accept("Not")) {
      out.kind = FuzzyExpression::Kind::invert;
      out.parts.push_back(inverted(depth + 1));
      out.depth = 1 + out.parts.front().depth;
      return out;
    }
    if (accept("(")) {
      out = either(depth + 1);
      if (!now().is(")"))
        expected("\")\", \"And\" or \"Or\"");
      take();
      return out;
    }
    if (now().kind == TokenKind::number) {
      out.value = take().value;
      if (out.value < 0.0 || out.value > 1.0)
        throw SyntaxError{out.place, "expected a fuzzy value from 0 to 1"};
      return out;
    }
    if (now().kind != TokenKind::symbol || fuzzy_keyword(now().text) || ends_section(now()))
      expected("a fuzzy variable, a number from 0 to 1, \"Not\" or \"(\"");
    out.kind = FuzzyExpression::Kind::name;
    out.name = std::string(take().text);
    // An underscore that the print has lost. What begins the next sentence is a keyword, or in the
    // rules the name of a rule, which is followed by "If".
    while (now().kind == TokenKind::symbol && !fuzzy_keyword(now().text) && !channel(now().text) &&
           !ends_section(now()) && !ahead(1).is("If")) {
      out.name += "_" + std::string(now().text);
      messages_.warn(now().place, "two names in a row are taken for \"" + out.name + "\"");
      take();
    }
    return out;
  }

  // Activity ------------------------------------------------------------------------------------

  static bool channel(std::string_view word) {
    return word == "Turn" || word == "Speed" || word == "Goal" || word == "Progress";
  }

  void activity(ParsedBehavior& out) {
    ParsedActivity activity;
    activity.place = now().place;
    if (now().kind != TokenKind::symbol || !channel(now().text))
      expected("\"Turn\", \"Speed\", \"Goal\" or \"Progress\"");
    activity.channel = std::string(take().text);
    for (const ParsedActivity& other : out.activity)
      if (other.channel == activity.channel)
        throw SyntaxError{activity.place, "\"" + activity.channel + "\" is there twice"};
    activity.value = either(0);
    out.activity.push_back(std::move(activity));
  }

  // C -------------------------------------------------------------------------------------------

  bool after_statement() {
    if (!now().is(";") && !now().is("}"))
      return false;
    ++at_;
    return true;
  }

  Statement statement(int depth = 0) {
    too_deep(depth, now().place);
    Statement out;
    out.place = now().place;
    if (accept(";"))
      return out;
    if (accept("{")) {
      while (!now().is("}")) {
        if (at_end() || ends_section(now()))
          expected("\"}\"");
        out.body.push_back(statement(depth + 1));
      }
      take();
      return out;
    }
    if (accept("if")) {
      out.kind = Statement::Kind::choice;
      expect("(");
      out.value = expression();
      expect(")");
      out.body.push_back(statement(depth + 1));
      if (accept("else"))
        out.otherwise.push_back(statement(depth + 1));
      return out;
    }
    if (now().kind != TokenKind::symbol || ends_section(now()))
      expected("a statement");
    for (const char* const loop : {"while", "for", "do", "goto", "switch", "return", "break"})
      if (now().is(loop))
        throw SyntaxError{now().place,
                          "expected a declaration, an assignment, a call or \"if\"; "
                          "there is no \"" +
                              std::string(loop) + "\" in this language"};
    if (names_type(now().text) && ahead(1).kind == TokenKind::symbol)
      return declaration();
    if (ahead(1).is("=") || assigns_with(ahead(1)))
      out = assignment();
    else {
      out.kind = Statement::Kind::expression;
      out.value = expression();
      if (out.value->kind != Expression::Kind::call)
        throw SyntaxError{out.place, "expected an assignment or a call"};
    }
    expect(";");
    return out;
  }

  static bool assigns_with(const Token& token) {
    return token.is("+=") || token.is("-=") || token.is("*=") || token.is("/=");
  }

  Statement assignment() {
    Statement out;
    out.kind = Statement::Kind::assign;
    out.place = now().place;
    const Token& name = take();
    out.name = std::string(name.text);
    naming_.push_back(out.name);
    const Token& sign = take();
    Expression right = expression();
    if (!sign.is("=")) {
      Expression both;
      both.kind = Expression::Kind::binary;
      both.place = sign.place;
      both.text = std::string(sign.text.substr(0, 1));
      Expression left;
      left.kind = Expression::Kind::name;
      left.place = name.place;
      left.text = out.name;
      both.depth = 1 + right.depth;
      both.parts.push_back(std::move(left));
      both.parts.push_back(std::move(right));
      right = std::move(both);
    }
    out.value = std::move(right);
    return out;
  }

  /// Several in one statement become a block.
  Statement declaration() {
    Statement out;
    out.place = now().place;
    const std::string_view word = take().text;
    const Type type = word == "int" ? Type::integer : word == "point" ? Type::point : Type::real;
    do {
      Statement one;
      one.kind = Statement::Kind::declare;
      one.place = now().place;
      one.type = type;
      one.name = std::string(expect_symbol("the name of a variable").text);
      naming_.push_back(one.name);
      if (accept("="))
        one.value = expression();
      out.body.push_back(std::move(one));
    } while (accept(","));
    if (!now().is(";"))
      expected("\";\", \",\" or \"=\"");
    take();
    return out;
  }

  Expression expression(int depth = 0) {
    too_deep(depth, now().place);
    Expression condition = binary(0, depth);
    if (!now().is("?"))
      return condition;
    Expression out;
    out.kind = Expression::Kind::conditional;
    out.place = take().place;
    out.parts.push_back(std::move(condition));
    out.parts.push_back(expression(depth + 1));
    expect(":");
    out.parts.push_back(expression(depth + 1));
    deepen(out);
    return out;
  }

  static void deepen(Expression& out) {
    for (const Expression& part : out.parts)
      out.depth = std::max(out.depth, 1 + part.depth);
    too_deep(out.depth, out.place);
  }

  /// How tightly an operator binds; 0: not one.
  static int binding(const Token& token) {
    if (token.kind != TokenKind::mark)
      return 0;
    constexpr std::pair<std::string_view, int> operators[] = {
        {"||", 1}, {"&&", 2}, {"==", 3}, {"!=", 3}, {"<", 4}, {"<=", 4}, {">", 4},
        {">=", 4}, {"+", 5},  {"-", 5},  {"*", 6},  {"/", 6}, {"%", 6}};
    for (const auto& [text, strength] : operators)
      if (token.text == text)
        return strength;
    return 0;
  }

  Expression binary(int least, int depth) {
    Expression left = unary(depth + 1);
    while (binding(now()) > least) {
      Expression out;
      out.kind = Expression::Kind::binary;
      out.place = now().place;
      const int strength = binding(now());
      out.text = std::string(take().text);
      out.parts.push_back(std::move(left));
      out.parts.push_back(binary(strength, depth + 1));
      deepen(out);
      left = std::move(out);
    }
    return left;
  }

  Expression unary(int depth) {
    too_deep(depth, now().place);
    Expression out;
    out.place = now().place;
    if (now().is("+")) {
      take();
      return unary(depth + 1);
    }
    if (now().is("-") || now().is("!")) {
      out.kind = take().is("-") ? Expression::Kind::negate : Expression::Kind::invert;
      out.parts.push_back(unary(depth + 1));
      deepen(out);
      return out;
    }
    if (now().is("(") && names_type(ahead(1).text) && ahead(2).is(")")) {
      out.kind = Expression::Kind::cast;
      out.type = ahead(1).is("int") ? Type::integer : Type::real;
      at_ += 3;
      out.parts.push_back(unary(depth + 1));
      deepen(out);
      return out;
    }
    return primary(depth);
  }

  Expression primary(int depth) {
    Expression out;
    out.place = now().place;
    if (now().kind == TokenKind::number) {
      out.whole = now().whole;
      out.value = take().value;
      return out;
    }
    if (now().kind == TokenKind::text) {
      out.kind = Expression::Kind::text;
      out.text = std::string(take().text);
      return out;
    }
    if (accept("(")) {
      out = expression(depth + 1);
      if (!now().is(")"))
        expected("\")\" or an operator");
      take();
      return out;
    }
    if (now().kind != TokenKind::symbol || ends_section(now()))
      expected("a number, a variable, a call or \"(\"");
    out.text = std::string(take().text);
    if (accept("(")) {
      out.kind = Expression::Kind::call;
      if (!accept(")")) {
        do
          out.parts.push_back(expression(depth + 1));
        while (accept(","));
        if (!now().is(")"))
          expected("\")\", \",\" or an operator");
        take();
      }
      deepen(out);
      return out;
    }
    out.kind = Expression::Kind::name;
    if (accept(".") || accept("->")) {
      Expression field;
      field.kind = Expression::Kind::field;
      field.place = out.place;
      field.text = std::string(expect_symbol("the name of a field").text);
      field.parts.push_back(std::move(out));
      deepen(field);
      return field;
    }
    return out;
  }

  const std::vector<Token>& tokens_;
  Messages& messages_;
  std::size_t at_ = 0;
  std::vector<std::string> naming_;  ///< what the sentence declares or sets
  std::vector<std::string> lost_;    ///< of sentences that could not be read
};

}  // namespace

std::string named(Type type) {
  switch (type) {
    case Type::nothing:
      return "nothing";
    case Type::integer:
    case Type::real:
      return "a number";
    case Type::point:
      return "a point";
    case Type::text:
      return "a text";
  }
  return "";
}

std::vector<ParsedBehavior> parse(const std::vector<Token>& tokens, Messages& messages) {
  return Parser(tokens, messages).all();
}

}  // namespace saphira::behaviors::language
