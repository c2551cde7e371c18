#include "uplift/laws/macro_uplift.h"

namespace uplift {

/// Two displacements of a foundation are kept, those of the ends of a step; eight foundations have a place of their own.
template <int R>
const MacroRocking& MacroUplift::recall(const Vec3& q) const {
  struct Kept {
    std::uint64_t version = 0;
    Vec3 at = Vec3::Zero();
    MacroRocking found;
  };
  struct Pair {
    Kept kept[2];
    int latest = 0;
  };
  thread_local Pair pairs[8];
  Pair& pair = pairs[version_ % 8];
  for (int turn = 0; turn < 2; ++turn) {
    const Kept& kept = pair.kept[pair.latest];
    if (kept.version == version_ && kept.at[0] == q[0] && kept.at[1] == q[1] && (R == 1 || kept.at[2] == q[2])) return kept.found;
    pair.latest = 1 - pair.latest;
  }
  pair.latest = 1 - pair.latest;
  Kept& kept = pair.kept[pair.latest];
  kept.version = version_;
  kept.at = q;
  kept.found = rock<R>(q, true);
  return kept.found;
}

template const MacroRocking& MacroUplift::recall<1>(const Vec3&) const;
template const MacroRocking& MacroUplift::recall<2>(const Vec3&) const;

}  // namespace uplift
