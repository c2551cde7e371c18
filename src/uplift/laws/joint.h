#pragma once
#include <memory>

#include "uplift/laws/normal.h"

// One normal part and one tangential part make an interface law. The tangential part is a set of parameters that every law has, so that a
// new law brings its normal part only.
namespace uplift {

/// The catalog entry of a law with the normal part that `make` builds from the checked parameters. The tangential parameters are added to
/// `info.params`; `tangential` is the standard choice ("none", "bonded", "open_free" or "coulomb").
Entry<InterfaceLaw> joint_entry(PartInfo info, const char* tangential, std::unique_ptr<const NormalLaw> (*make)(const Values&));

}  // namespace uplift
