#pragma once
#include <string>
#include <utility>
#include <vector>

#include "uplift/base/declare.h"

// KEY=VALUE words of a command line, as the entries of a table in a case file.
namespace uplift::cli {

using Words = std::vector<std::pair<std::string, Raw>>;

/// KEY=VALUE, the value as in a case file; a text may stand there without quotes. `place`: the command, for messages. Throws InputError.
std::pair<std::string, Raw> word_of(const std::string& word, const std::string& place);
/// Throws InputError where a key stands twice.
void refuse_twice(const Words& words, const std::string& place);
Raw table_of(Words words, const std::string& place);

}  // namespace uplift::cli
