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
  double usual = 0.0;                  ///< of numbers and truths that are not given
  bool whole = false;                  ///< of numbers
  std::vector<std::string> choices{};  ///< of texts; empty: any text
  Frame frame = Frame::map;            ///< of points
  bool list = false;                   ///< may be given several times, or not at all
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

/// Something that a program can be asked for.
struct Functor {
  std::string name;
  std::string summary;  ///< one line for people
  std::vector<Parameter> parameters{};
};

/// The trouble with the arguments, naming functor and argument, and saying what was expected and
/// what came; empty where nothing is. Then what is not given has been filled in with what is usual.
std::string complete(const Functor& functor, Arguments& arguments);

/// A line for each functor, with its arguments, for people.
std::string help(const std::vector<Functor>& functors);

}  // namespace saphira
