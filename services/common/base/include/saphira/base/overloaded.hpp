#pragma once

namespace saphira {

/// For std::visit: several lambdas as one, of which the argument chooses.
template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

}  // namespace saphira
