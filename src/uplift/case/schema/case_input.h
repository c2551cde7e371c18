#pragma once
#include <array>

#include "uplift/case/schema/analysis_sections.h"
#include "uplift/case/schema/comparison_sections.h"
#include "uplift/case/schema/interface_sections.h"
#include "uplift/case/schema/output_sections.h"
#include "uplift/case/schema/structure_sections.h"
#include "uplift/case/schema/verdict_sections.h"

namespace uplift {

struct Mesh;

/// The checked case file as structs, tables in the order of the file. They point to tables of the values that they were read from,
/// never to the values themselves, which move with the case.
struct CaseInput {
  std::optional<CaseMeshSource> mesh;
  std::array<std::vector<CaseElement>, 4> elements;  // by their place
  const std::vector<CaseElement>& elements_at(ElementPlace place) const { return elements[static_cast<std::size_t>(place)]; }
  std::vector<CaseAbsorbing> absorbing;
  std::vector<CaseTie> ties;
  std::vector<CaseInterface> interfaces;
  std::vector<CaseFoundation> foundations;
  // what depends on whether the model is plane
  Space space;
  std::vector<CaseNode> nodes;
  std::vector<CaseMass> masses;
  std::vector<CaseBody> bodies;
  std::vector<CaseSupport> supports;
  std::vector<CaseMotion> motions;
  std::vector<CaseGround> grounds;
  std::optional<CaseGravity> gravity;
  std::vector<CaseFunction> functions;
  std::vector<CaseRecordSource> records;
  std::vector<CaseLoad> loads;
  std::vector<CaseInitial> initial;
  std::vector<CaseStage> stages;
  CaseEnergy energy;
  CaseLimits limits;
  CaseOutput output;
  // how it is run
  std::string title, description;
  bool bonded = true;
  const Values *method = nullptr, *impact = nullptr;  // null: not stated
  const Values* solver = nullptr;
  std::optional<CaseDamping> damping;
  CaseVerdict verdict;
  std::string interface_solver;
  std::optional<std::string> reduced_model;
  std::vector<CaseVariant> variants;
  std::optional<CaseComparison> compare;
  CaseTrust trust;
  std::vector<CaseOrigin> origins;
  std::vector<CaseFigure> figures;
};

/// The tables by which the mesh is made and opened. Throws InputError, as the next one.
CaseInput input_of_mesh(const Values& root);
/// All others. Plane or space: as the mesh, else as the first node.
void add_rest_of_input(const Values& root, const Mesh* mesh, CaseInput& made);

}  // namespace uplift
