#pragma once
#include <link.h>

#include <cstdint>
#include <span>
#include <string>

// Which program runs: from its image in memory, without reading its file.
namespace uplift {

/// What tells a linked program or library from others, the same for every copy of it: the build id, which the linker makes of everything
/// that it writes (ELF note NT_GNU_BUILD_ID), and the bytes that its segments take. Empty where the linker made no id. `begin`: where the
/// image is loaded; `headers`: its segments.
std::string build_id_of(std::uintptr_t begin, std::span<const ElfW(Phdr)> headers);

/// Of the program or the library that contains this function: its build id, or else the SHA-256 of its file. Throws InputError where that
/// file cannot be read.
std::string identity_of_program();

/// The names of all shared libraries that are loaded beside it, with their build ids, one a line: the mathematical ones decide the last
/// bits of results, too.
std::string identity_of_libraries();

}  // namespace uplift
