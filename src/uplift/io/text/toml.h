#pragma once
#include <string>
#include <string_view>

#include "uplift/base/declare.h"

// TOML 1.0 -> Raw, by toml++. Every value keeps its file and line; tables keep the order of the file.
namespace uplift {

/// Reads a file. Throws InputError when it cannot be read (with the nearest name in its folder) and for everything of read_toml_text.
Raw read_toml_file(const std::string& path);

/// Reads a text; `file` is its name in messages. Throws InputError: TOML errors with their line (duplicate keys are errors of TOML), text
/// that is not UTF-8, more than 16 MiB, more than 64 levels, and dates and times, which no input takes.
Raw read_toml_text(std::string_view text, const std::string& file);

}  // namespace uplift
