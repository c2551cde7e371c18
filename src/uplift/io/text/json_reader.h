#pragma once
#include <string>
#include <string_view>

#include "uplift/base/declare.h"

// JSON -> Raw, by nlohmann/json. Tables keep the order of the text; values have a path but no line.
namespace uplift {

/// Reads a JSON text whose outermost value is an object; `file` is its name in messages. Throws InputError: JSON errors with their line and
/// column, null, more than 16 MiB, more than 64 levels, and a key that comes twice.
Raw read_json_text(std::string_view text, const std::string& file);

/// The other way round: the value as JSON text. Numbers that JSON lacks (infinite or not a number) become texts.
std::string json_text(const Raw& raw);

}  // namespace uplift
