#pragma once

#include <string>
#include <vector>

#include "ast.hpp"
#include "cursor.hpp"

namespace saphira::behaviors::language {

/// Parses the C of Init and Update.
class CParser {
 public:
  explicit CParser(Cursor& cursor) : cursor_(cursor) {}

  Statement statement(int depth = 0);
  /// True past the end of a statement that could not be read.
  bool after_statement();
  /// The variable that the present sentence declares or sets; the parser of parameters sets it as
  /// well.
  std::vector<std::string>& naming() { return naming_; }

 private:
  Statement assignment();
  /// Several in one statement become a block.
  Statement declaration();
  Expression expression(int depth = 0);
  Expression binary(int least, int depth);
  Expression unary(int depth);
  Expression primary(int depth);

  Cursor& cursor_;
  std::vector<std::string> naming_;
};

}  // namespace saphira::behaviors::language
