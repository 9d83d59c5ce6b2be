#include "c_parser.hpp"

#include <algorithm>

namespace saphira::behaviors::language {
namespace {

bool names_type(std::string_view word) {
  return word == "int" || word == "float" || word == "double" || word == "point";
}

bool assigns_with(const Token& token) {
  return token.is("+=") || token.is("-=") || token.is("*=") || token.is("/=");
}

void deepen(Expression& out) {
  for (const Expression& part : out.parts)
    out.depth = std::max(out.depth, 1 + part.depth);
  limit_depth(out.depth, out.place);
}

/// How tightly an operator binds; 0: not one.
int binding(const Token& token) {
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

}  // namespace

bool CParser::after_statement() {
  if (!cursor_.now().is(";") && !cursor_.now().is("}"))
    return false;
  cursor_.skip();
  return true;
}

Statement CParser::statement(int depth) {
  limit_depth(depth, cursor_.now().place);
  Statement out;
  out.place = cursor_.now().place;
  if (cursor_.accept(";"))
    return out;
  if (cursor_.accept("{")) {
    while (!cursor_.now().is("}")) {
      if (cursor_.at_end() || ends_section(cursor_.now()))
        cursor_.expected("\"}\"");
      out.body.push_back(statement(depth + 1));
    }
    cursor_.take();
    return out;
  }
  if (cursor_.accept("if")) {
    out.kind = Statement::Kind::choice;
    cursor_.expect("(");
    out.value = expression();
    cursor_.expect(")");
    out.body.push_back(statement(depth + 1));
    if (cursor_.accept("else"))
      out.otherwise.push_back(statement(depth + 1));
    return out;
  }
  if (cursor_.now().kind != TokenKind::symbol || ends_section(cursor_.now()))
    cursor_.expected("a statement");
  for (const char* const loop : {"while", "for", "do", "goto", "switch", "return", "break"})
    if (cursor_.now().is(loop))
      throw SyntaxError{cursor_.now().place,
                        "expected a declaration, an assignment, a call or \"if\"; "
                        "there is no \"" +
                            std::string(loop) + "\" in this language"};
  if (names_type(cursor_.now().text) && cursor_.ahead(1).kind == TokenKind::symbol)
    return declaration();
  if (cursor_.ahead(1).is("=") || assigns_with(cursor_.ahead(1)))
    out = assignment();
  else {
    out.kind = Statement::Kind::expression;
    out.value = expression();
    if (out.value->kind != Expression::Kind::call)
      throw SyntaxError{out.place, "expected an assignment or a call"};
  }
  cursor_.expect(";");
  return out;
}

Statement CParser::assignment() {
  Statement out;
  out.kind = Statement::Kind::assign;
  out.place = cursor_.now().place;
  const Token& name = cursor_.take();
  out.name = std::string(name.text);
  naming_.push_back(out.name);
  const Token& sign = cursor_.take();
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

Statement CParser::declaration() {
  Statement out;
  out.place = cursor_.now().place;
  const std::string_view word = cursor_.take().text;
  const Type type = word == "int" ? Type::integer : word == "point" ? Type::point : Type::real;
  do {
    Statement one;
    one.kind = Statement::Kind::declare;
    one.place = cursor_.now().place;
    one.type = type;
    one.name = std::string(cursor_.expect_symbol("the name of a variable").text);
    naming_.push_back(one.name);
    if (cursor_.accept("="))
      one.value = expression();
    out.body.push_back(std::move(one));
  } while (cursor_.accept(","));
  if (!cursor_.now().is(";"))
    cursor_.expected("\";\", \",\" or \"=\"");
  cursor_.take();
  return out;
}

Expression CParser::expression(int depth) {
  limit_depth(depth, cursor_.now().place);
  Expression condition = binary(0, depth);
  if (!cursor_.now().is("?"))
    return condition;
  Expression out;
  out.kind = Expression::Kind::conditional;
  out.place = cursor_.take().place;
  out.parts.push_back(std::move(condition));
  out.parts.push_back(expression(depth + 1));
  cursor_.expect(":");
  out.parts.push_back(expression(depth + 1));
  deepen(out);
  return out;
}

Expression CParser::binary(int least, int depth) {
  Expression left = unary(depth + 1);
  while (binding(cursor_.now()) > least) {
    Expression out;
    out.kind = Expression::Kind::binary;
    out.place = cursor_.now().place;
    const int strength = binding(cursor_.now());
    out.text = std::string(cursor_.take().text);
    out.parts.push_back(std::move(left));
    out.parts.push_back(binary(strength, depth + 1));
    deepen(out);
    left = std::move(out);
  }
  return left;
}

Expression CParser::unary(int depth) {
  limit_depth(depth, cursor_.now().place);
  Expression out;
  out.place = cursor_.now().place;
  if (cursor_.now().is("+")) {
    cursor_.take();
    return unary(depth + 1);
  }
  if (cursor_.now().is("-") || cursor_.now().is("!")) {
    out.kind = cursor_.take().is("-") ? Expression::Kind::negate : Expression::Kind::invert;
    out.parts.push_back(unary(depth + 1));
    deepen(out);
    return out;
  }
  if (cursor_.now().is("(") && names_type(cursor_.ahead(1).text) && cursor_.ahead(2).is(")")) {
    out.kind = Expression::Kind::cast;
    out.type = cursor_.ahead(1).is("int") ? Type::integer : Type::real;
    cursor_.skip(3);
    out.parts.push_back(unary(depth + 1));
    deepen(out);
    return out;
  }
  return primary(depth);
}

Expression CParser::primary(int depth) {
  Expression out;
  out.place = cursor_.now().place;
  if (cursor_.now().kind == TokenKind::number) {
    out.whole = cursor_.now().whole;
    out.value = cursor_.take().value;
    return out;
  }
  if (cursor_.now().kind == TokenKind::text) {
    out.kind = Expression::Kind::text;
    out.text = std::string(cursor_.take().text);
    return out;
  }
  if (cursor_.accept("(")) {
    out = expression(depth + 1);
    if (!cursor_.now().is(")"))
      cursor_.expected("\")\" or an operator");
    cursor_.take();
    return out;
  }
  if (cursor_.now().kind != TokenKind::symbol || ends_section(cursor_.now()))
    cursor_.expected("a number, a variable, a call or \"(\"");
  out.text = std::string(cursor_.take().text);
  if (cursor_.accept("(")) {
    out.kind = Expression::Kind::call;
    if (!cursor_.accept(")")) {
      do
        out.parts.push_back(expression(depth + 1));
      while (cursor_.accept(","));
      if (!cursor_.now().is(")"))
        cursor_.expected("\")\", \",\" or an operator");
      cursor_.take();
    }
    deepen(out);
    return out;
  }
  out.kind = Expression::Kind::name;
  if (cursor_.accept(".") || cursor_.accept("->")) {
    Expression field;
    field.kind = Expression::Kind::field;
    field.place = out.place;
    field.text = std::string(cursor_.expect_symbol("the name of a field").text);
    field.parts.push_back(std::move(out));
    deepen(field);
    return field;
  }
  return out;
}

}  // namespace saphira::behaviors::language
