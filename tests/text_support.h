#pragma once
#include <gtest/gtest.h>

#include <string>

#include "uplift/base/error.h"

namespace uplift::support {

/// The text with the first `old` replaced; a failure of the test when it is not there.
inline std::string replaced(std::string text, const std::string& old, const std::string& with) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, text.npos) << old;
  return at == text.npos ? text : text.replace(at, old.size(), with);
}

/// What is said against an input, or "accepted".
template <class Attempt>
std::string refusal_of(Attempt&& attempt) {
  try {
    attempt();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace uplift::support
