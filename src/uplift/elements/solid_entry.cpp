#include "uplift/elements/element_entry.h"
#include "uplift/elements/solid_nonlinear.h"

// The table [[solid]]: a continuum in the cells of a group of the mesh, elastic or of a bulk law.
namespace uplift {
namespace {

SolidSection section_from(const Values& solid) {
  SolidSection section;
  const bool stiffness = solid.has("E");
  if (stiffness == solid.has("shear_wave_speed"))
    fail(solid, stiffness ? "shear_wave_speed" : "", "either E or shear_wave_speed", stiffness ? "both" : "neither");
  const std::string& mass = solid.text("mass");
  if ((mass != "none" || !stiffness) && !solid.has("density"))
    fail(solid, "", mass == "none" ? "density, from which E follows with shear_wave_speed" : "density, or mass = \"none\"", "none");
  const double density = solid.has("density") ? solid.number("density") : 0, poisson = solid.number("poisson");
  section.material = stiffness ? ElasticMaterial{solid.number("E"), poisson, density}
                               : material_of_wave_speed(solid.number("shear_wave_speed"), poisson, density);
  check_material(section.material, solid.where(), solid.path());
  section.plane = solid.text("plane") == "strain" ? PlaneState::strain : PlaneState::stress;
  section.thickness = solid.number("thickness");
  section.mass = mass == "consistent" ? SolidSection::Mass::consistent
                 : mass == "lumped"   ? SolidSection::Mass::lumped
                                      : SolidSection::Mass::none;
  section.incompatible_modes = solid.flag("incompatible_modes");
  return section;
}

/// Null: elastic.
std::shared_ptr<const BulkLaw> law_from(const Values& solid, const SolidSection& section, int dimension) {
  if (solid.has("plasticity") && solid.has("law")) fail(solid, "plasticity", "either law or plasticity, its older name", "both");
  const Values* stated = stated_bulk_law(solid);
  if (stated == nullptr) return nullptr;
  std::shared_ptr<const BulkLaw> law = make_part(bulk_law_catalog(), *stated, {section.material, dimension});
  if (!law->linear() && section.plane == PlaneState::stress)
    fail(solid, "plane", "plane = \"strain\" for a solid whose law is not elastic", "\"stress\"");
  return law;
}

class SolidFilling final : public CellFilling {
 public:
  SolidFilling(const Values& solid, int dimension)
      : section_(std::make_shared<const SolidSection>(section_from(solid))),
        law_(law_from(solid, *section_, dimension)),
        beta_(solid.number("damping_beta")) {}
  const SolidSection& section() const override { return *section_; }
  double damping_beta() const override { return beta_; }
  std::unique_ptr<Element> make(const CellSite& site) const override {
    std::unique_ptr<Element> element;
    if (!law_ || law_->linear())
      element = std::make_unique<Solid>(site.cell, site.nodes, site.coordinates, section_, site.part);
    else
      element = std::make_unique<NonlinearSolid>(site.cell, site.nodes, site.coordinates, *section_, law_, site.part);
    element->beta = beta_;
    return element;
  }

 private:
  std::shared_ptr<const SolidSection> section_;
  std::shared_ptr<const BulkLaw> law_;
  double beta_;  // s
};

}  // namespace

const Values* stated_bulk_law(const Values& cells) {
  for (const char* key : {"plasticity", "law"})
    if (cells.items().contains(key) && cells.has(key)) return &cells.part(key);
  return nullptr;
}

const ElementEntry& entry_element_solid() {
  static const ElementEntry entry{
      {{.name = "solid",
        .summary = "what a group of cells of the mesh is made of; every cell needs one",
        .equations = "K = int B^T D B dV, M = int rho N^T N dV; with a law: internal force int B^T stress dV",
        .source = "Zienkiewicz & Taylor, The Finite Element Method, vol. 1; docs/theory, section 9",
        .params =
            {text("group", "group of cells"), number("E", "Pa", "Young's modulus; or give shear_wave_speed").positive().optional(),
             number("shear_wave_speed", "m/s", "speed of shear waves, from which E follows: G = density x speed squared")
                 .positive()
                 .optional(),
             number("poisson", "1", "Poisson's ratio, below 0.5").between(0, 0.4999),
             number("density", "kg/m3", "density; not needed with mass = \"none\" and E").positive().optional(),
             choice("plane", {"strain", "stress"}, "what is zero out of the plane (plane meshes)").standard("strain"),
             number("thickness", "m", "length out of the plane (plane meshes)").positive().standard(1.0),
             choice("mass", {"consistent", "lumped", "none"}, "mass matrix").standard("consistent"),
             flag("incompatible_modes", "quad4 and hex8: bubbles that let an element bend").standard(true),
             part("law", bulk_laws,
                  "stress from strain; absent: elastic. Other laws need plane strain or space, and every step then iterates on them around "
                  "the linear step")
                 .optional(),
             part("plasticity", bulk_laws, "older name of law; without type: drucker_prager").optional().standard_type("drucker_prager"),
             number("damping_beta", "s", "stiffness-proportional damping factor of this solid alone").nonnegative().standard(0.0)}},
       nullptr},
      "",
      ElementPlace::cells,
      [](const Values& solid, int dimension) -> std::unique_ptr<const CellFilling> {
        return std::make_unique<SolidFilling>(solid, dimension);
      }};
  return entry;
}

}  // namespace uplift
