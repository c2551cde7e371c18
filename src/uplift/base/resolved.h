#pragma once
#include <map>
#include <string>

#include "uplift/base/declare.h"

namespace uplift {

/// Texts that the program puts in the place of a default because of other keys, by the path of their key ("stage[1].traction").
using DecidedTexts = std::map<std::string, std::string>;
/// to_toml (base/declare.h) with them.
std::string to_toml(const Values& values, const DecidedTexts& decided);

}  // namespace uplift
