#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "uplift/motion/target.h"

namespace uplift {

inline Raw target_raw(decltype(Raw::data) data) {
  return {std::move(data), {"case.toml", 3}, "target"};
}
inline Raw target_raw(const char* text) {
  return target_raw(std::string(text));
}
inline Raw target_raw(const std::vector<double>& values) {
  RawList list;
  for (const double value : values) list.push_back(target_raw(value));
  return target_raw(std::move(list));
}

/// A target of the catalog from its keys, as a case file would give it.
inline std::unique_ptr<const TargetSpectrum> target_of(const char* type, std::vector<std::pair<std::string, Raw>> keys) {
  keys.insert(keys.begin(), {"type", target_raw(type)});
  for (auto& [key, value] : keys) value.path = "target." + key;
  return make_part(target_catalog(), check_part(target_raw(std::make_shared<RawTable>(RawTable{std::move(keys)})), target_spectra()));
}

}  // namespace uplift
