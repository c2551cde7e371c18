#pragma once
#include <string>
#include <variant>

namespace uplift {

/// Why there is no answer: one sentence without a full stop.
struct Refused {
  std::string reason;
};

/// An answer, or the reason why there is none. `if (const Fragility* fit = std::get_if<Fragility>(&result))` reads it.
template <class T>
using OrRefused = std::variant<T, Refused>;

}  // namespace uplift
