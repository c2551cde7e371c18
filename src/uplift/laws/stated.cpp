#include "uplift/laws/stated.h"

namespace uplift {

StatedNumbers stated_numbers(const Values& behaviour) {
  const auto stated = [&](std::string_view key) {
    const bool number = behaviour.items().contains(key) && behaviour.has(key) && !behaviour.is_word(key);
    return number ? std::optional(behaviour.number(key)) : std::nullopt;
  };
  return {stated("friction"), stated("cohesion"), stated("friction_angle"), stated("c"), stated("V_s"), stated("V_u")};
}

}  // namespace uplift
