#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "uplift/base/catalog.h"
#include "uplift/elements/solid.h"

namespace uplift {

/// The nodes that one element connects.
struct ElementSite {
  Space space;
  std::vector<int> nodes;
  std::vector<Vec3> positions;  // m
  std::string line = {};        // along the lines of a group: which one, for messages
};

/// A cell of the mesh for one element: its nodes in the order of the cell.
struct CellSite {
  Cell cell;
  std::span<const int> nodes;
  Coordinates coordinates;
  const CellRule* part = nullptr;  // the cell is filled in part (mesh/cut.h); null: it is whole
};

/// What fills the cells of a group: read once from its table, then asked for one element a cell. The elements state continuum() and cell().
class CellFilling {
 public:
  virtual ~CellFilling() = default;
  /// Material and thickness, also for what stands beside the cells: faces, surfaces of interfaces and loads.
  virtual const SolidSection& section() const = 0;
  virtual double damping_beta() const = 0;  // s, of its elements
  virtual std::unique_ptr<Element> make(const CellSite& site) const = 0;
};

/// What an element on a face stands beside: the cells of this group.
struct FillingBeside {
  const SolidSection& section;
  const std::string& group;
};

/// A kind of element: a table [[name]] of the case file with the keys `params`. One of the three functions makes it.
/// - `make`, from ElementPlace::nodes: it stands on the nodes that it names under `nodes`; from ElementPlace::lines: between two `nodes` or
///   on the lines of a `group` of the mesh, with the keys `name` and `elements` (of each straight stretch).
/// - `fill`, from ElementPlace::cells: it fills the cells of a `group` of the mesh, of this dimension.
/// - `cover`, from ElementPlace::faces: it stands on the edges (in space: faces) of a `group` of the mesh.
enum class ElementPlace { nodes, lines, cells, faces };
struct ElementEntry : Entry<Element, ElementSite> {
  std::string_view symbol = "spring";        // between its nodes in the drawing of the model: "spring" or "dashpot"; else not used
  ElementPlace place = ElementPlace::nodes;  // elements on lines have two nodes, an axis, section forces
  std::unique_ptr<const CellFilling> (*fill)(const Values&, int dimension) = nullptr;
  std::unique_ptr<Element> (*cover)(const CellSite&, const Values&, const FillingBeside&, Space) = nullptr;
};
std::span<const ElementEntry* const> element_catalog();
/// Those that stand at one kind of place.
std::vector<const ElementEntry*> elements_at(ElementPlace place);
std::span<const PartInfo* const> element_kinds();
/// The law that a table of cells states, under `law` or `plasticity`, its older name; null: elastic.
const Values* stated_bulk_law(const Values& cells);
/// Whether a [[beam]] states a density that makes no mass.
bool has_idle_density(const Values& beam);

/// Two numbers in plane models, three in space; InputError otherwise.
Place vector_of(const Values& table, std::string_view key, Space space);

}  // namespace uplift
