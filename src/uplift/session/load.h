#pragma once
#include <map>
#include <string>

#include "uplift/case/case.h"
#include "uplift/io/results/summary.h"
#include "uplift/laws/external.h"

namespace uplift {

/// Where mesh files that need the HDF5 library (MED) are read: in a child process, which a damaged file cannot take down with it
/// (programs), or in this process (libraries must not fork).
enum class MeshFiles { isolated, in_process };

/// A case file, read and checked, with its provenance.
struct LoadedCase {
  Raw raw;  // the file as it stands
  Case read;
  Provenance from;
  MeshFiles mesh_files = MeshFiles::isolated;
  MeshReader read_mesh;                                   // reads the mesh of a changed case
  std::map<std::string, ExternalFunction> external_laws;  // of the caller, by name
};

/// Reads and checks a case file, or the case.toml of a folder. `command` is recorded in the results. Throws InputError.
LoadedCase load_case(const std::string& file, const std::string& command, MeshFiles files = MeshFiles::isolated);
/// The same for a text in TOML, or in JSON where its first character is a brace. `file` is its name in messages; relative paths in the
/// case start from its folder. Errors in a JSON text have no line.
LoadedCase load_case_text(const std::string& text, const std::string& file, const std::string& command,
                          MeshFiles files = MeshFiles::isolated);

/// Folder of the results that is used when none is given: out/NAME with the name of the case's folder (for case.toml) or file.
std::string default_result_path(const Case& read);

}  // namespace uplift
