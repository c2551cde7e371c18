#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "uplift/case/mesh/mesh.h"

// The lines of a mesh that are beams; used by case/build/beam.cpp alone.
namespace uplift {

/// Hands the lines of groups out to beams: each to one beam, and none that is an opened surface or absorbs waves.
class BeamCells {
 public:
  /// `solids`: null without a mesh.
  BeamCells(const Case& read, const CaseSolids* solids);
  /// A straight piece of a beam between two nodes of the mesh.
  struct Stretch {
    CellId cell;
    int number;  // of the cell in the group, from 1
    int a, b;
    Vec3 along;  // m, from a to b
  };
  /// The lines of the beam's group, in its order: a line2 is one stretch, a line3 two, from end to middle to end. Throws InputError.
  std::vector<Stretch> take(const CaseElement& beam);
  /// For messages.
  std::string name(CellId cell) const { return describe_cell(solids_->mesh(), cell); }

 private:
  void check_use(const CaseElement& beam, CellId cell) const;
  void claim(const CaseElement& beam, const Stretch& stretch);

  const Case& read_;
  const CaseSolids* solids_;
  std::map<std::pair<int, int>, const CaseElement*> taken_;  // by the nodes, ascending
};

/// Lines that share an end with exactly one other become one line with it: what remains ends where lines branch or stop. Closed lines end
/// where they begin.
std::vector<std::vector<int>> strung(std::vector<std::vector<int>> lines);

}  // namespace uplift
