#pragma once

#include <string>
#include <vector>

#include "saphira/requests/request.hpp"

// The slots of requests and answers.
namespace saphira::agent_interface {

/// The error in the arguments, from complete(). An open slot fits where the answer may fill it.
std::string misfit(const Functor& functor, const Arguments& arguments);
/// The first place where an answer is not as the functor declares it, and the expected value;
/// empty: none.
std::string contradiction(const Functor& functor, const Answer& answer);

/// An unbound argument with a text: a variable of a conjunction.
bool is_variable(const Argument& argument);
/// The arguments of a part of a conjunction, with the values of its variables.
Arguments with_values(Arguments arguments, const Arguments& bound);
/// The values of all variables after an answer to a part: one row for each value of a slot.
std::vector<Arguments> rows_of(const Arguments& part, const Arguments& bound,
                               const Arguments& results);

}  // namespace saphira::agent_interface
