#pragma once
#include <memory>
#include <string>

#include "unit/contact/contact_support.h"

namespace uplift::contact_test {

struct Law {
  const char* type;
  double friction;  // 0: no shear
  const char* tangential = "coulomb";
};

/// A law of the catalog on three components, with its scales in proportion to the stiffness [Pa/m].
inline std::unique_ptr<const InterfaceLaw> law_of(const Law& law, double stiffness) {
  auto table = std::make_shared<RawTable>();
  const auto put = [&](const char* key, auto value) { table->entries.emplace_back(key, Raw{value, {}, key}); };
  put("type", std::string(law.type));
  put("K_n", stiffness);
  if (std::string(law.type) == "sdm") put("F_u", 2e-6 * stiffness), put("G_f", 1e-11 * stiffness), put("F_c", -1e-8 * stiffness);
  const bool coulomb = std::string(law.tangential) == "coulomb";
  if (coulomb && law.friction > 0) put("friction", law.friction);
  if (!coulomb || law.friction > 0) put("tangential", std::string(law.tangential)), put("K_t", 0.5 * stiffness);
  return make_part(law_catalog(), check_part(Raw{table, {}, "test"}, interface_behaviours()));
}

}  // namespace uplift::contact_test
