#pragma once
#include <string>
#include <string_view>

#include "uplift/base/error.h"
#include "uplift/mesh/mesh.h"

// What the process that reads a MED file sends back: a mesh, or what is wrong with the file.
namespace uplift {

std::string message_of(const Mesh& mesh);
std::string message_of(const InputError& error);

/// The mesh, or the error thrown again. The message itself is not trusted: it may come from a process whose memory the file has damaged.
/// Numbers are counted before room is made for them, and whatever a mesh refers to is there; else an InputError at `where` says that the
/// file is damaged. (Whether the mesh makes sense is for check_mesh to say, as after every reader.)
Mesh mesh_of_message(std::string_view bytes, const Where& where);

}  // namespace uplift
