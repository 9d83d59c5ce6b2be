#pragma once

#include <string>
#include <vector>

#include "saphira/requests/argument.hpp"

namespace saphira {

/// A parameter of a functor.
struct Parameter {
  std::string name;
  ArgumentKind kind = ArgumentKind::number;
  std::string meaning;  ///< with its unit, for people
  bool required = true;
  double low = 0.0;  ///< of numbers
  double high = 0.0;
  double usual = 0.0;                  ///< default of numbers and truths
  bool whole = false;                  ///< of numbers
  std::vector<std::string> choices{};  ///< of texts; empty: any text
  Frame frame = Frame::map;            ///< of points
  bool list = false;                   ///< may be given any number of times
};

/// Tables of functors are made of these.
Parameter number_parameter(std::string name, std::string meaning, double low, double high);
Parameter whole_parameter(std::string name, std::string meaning, double low, double high);
Parameter text_parameter(std::string name, std::string meaning,
                         std::vector<std::string> choices = {});
Parameter point_parameter(std::string name, std::string meaning, Frame frame);
Parameter truth_parameter(std::string name, std::string meaning);
Parameter optional(Parameter parameter, double usual = 0.0);
Parameter list(Parameter parameter);

/// A request that a program can carry out.
struct Functor {
  std::string name;
  std::string summary;  ///< one line for people
  std::vector<Parameter> parameters{};
};

/// The error in the arguments, with functor and argument, the expected and the actual value; empty:
/// none. Then missing arguments have been filled with their defaults.
std::string complete(const Functor& functor, Arguments& arguments);

/// A line for each functor, with its arguments, for people.
std::string help(const std::vector<Functor>& functors);

}  // namespace saphira
