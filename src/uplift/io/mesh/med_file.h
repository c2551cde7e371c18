#pragma once
#include <string>
#include <string_view>

#include "uplift/mesh/mesh.h"

namespace uplift {

/// read_med() for a file of unknown origin, in a process of its own (see hdf5_child.h; at the time of the call no other thread should be
/// using HDF5). A file at which the library crashes, or does not come to an end, is an InputError like any other that is damaged.
/// Limits of that process: memory of 1 GB and 64 times the file's size; computing of 5 s and 1 s for every 2 MB (it needs 6 ms for one).
Mesh read_med_file(const std::string& path, const std::string& mesh = {});
/// The same for a file in memory; `name` stands for it in messages.
Mesh read_med_bytes(std::string_view bytes, const std::string& name, const std::string& mesh = {});

/// The same in this process, for libraries, which must not fork. A damaged file may end the process.
Mesh read_med_here(const std::string& path, const std::string& mesh = {});

}  // namespace uplift
