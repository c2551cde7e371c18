#include <map>

#include "uplift/case/build/forces.h"
#include "uplift/io/fields/run_frames.h"

namespace uplift {

void BeamFrames::add(const CaseElement& beam, const CaseSolids& solids, const BuiltCase& built, const FieldMesh& block) {
  space_ = built.model.space;
  // The elements of a beam follow its lines in the order of the group: the same number for each, twice as many where a line has a node in
  // its middle.
  const auto line = std::ranges::find(built.beams, beam.name.name, &BeamLine::name);
  std::map<CellId, std::pair<int, double>> middle;  // element, share of its length
  int next = line->first_element;
  for (const CellId cell : solids.lines(*beam.group)) {
    const int elements = beam.pieces * (solids.mesh().cell(cell).size() == 3 ? 2 : 1);
    middle[cell] = elements % 2 == 0 ? std::pair(next + elements / 2 - 1, 1.0) : std::pair(next + elements / 2, 0.5);
    next += elements;
  }
  first_.push_back(quantities_.size());
  lines_.push_back(block.cell.size());
  const auto components = static_cast<Index>(section_components(space_).size());
  for (Index k = 0; k < components; ++k)
    for (const CellId cell : block.cell) {
      const auto [element, share] = middle.at(cell);
      const SectionForces::Part part{element, share, Vector::Unit(components, k)};
      held_.push_back(std::make_unique<const SectionForces>(std::vector<std::vector<SectionForces::Part>>{{part}}));
      quantities_.push_back(held_.back().get());
    }
}

std::vector<FieldValues> BeamFrames::fields(std::size_t beam, const std::vector<double>& values) const {
  std::vector<FieldValues> made;
  std::size_t from = first_[beam];
  for (const SectionComponent& component : section_components(space_)) {
    FieldValues& field = made.emplace_back();
    field.name = component.word, field.unit = component.unit;
    if (!values.empty()) field.values.assign(&values[from], &values[from] + lines_[beam]);
    from += lines_[beam];
  }
  return made;
}

}  // namespace uplift
