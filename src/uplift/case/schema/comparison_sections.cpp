#include "uplift/case/schema/comparison_sections.h"

#include "uplift/contact/impact/impact.h"
#include "uplift/contact/method.h"
#include "uplift/dynamics/scheme.h"
#include "uplift/laws/law.h"

namespace uplift {
namespace {

using Fields = std::vector<Field>;

const Section& sweep_section() {
  static const Section s{
      "stiffness_sweep", "energy error of a traction law against its stiffness, for both tractions",
      Fields{part("law", interface_behaviours, "the law; its stiffness is replaced"),
             text("parameter", "parameter of the law that is the stiffness").standard("K_n"),
             numbers("ratios", "1", "stiffness ratios k F_ii (largest of the points)"),
             flag("rigid_ground", "leave out the elastic bed: the swept joint is the only flexibility of the ground").standard(false),
             part("impact", impact_rules, "velocity correction with the traction at the end of the step").standard("none"),
             number("duration", "s", "duration of the dynamic stage; absent: that of the case").positive().optional()}};
  return s;
}

CaseSweep case_sweep(const Values& table) {
  return {{&table},
          &table.part("law"),
          table.text("parameter"),
          table.numbers("ratios"),
          table.flag("rigid_ground"),
          &table.part("impact"),
          number_if(table, "duration")};
}

}  // namespace

const Section& variant_section() {
  static const Section s{
      "variant", "for `uplift compare`: the same case with another law, method, rule, scheme or step, or another case",
      Fields{
          text("name", "name of its runs"), text("label", "as shown").optional(),
          text("case",
               "file of another case that is run instead, with nothing of this one: the same structure on another model of the ground; its "
               "own variants are left out, and its floor spectra unless they are those of this case")
              .optional(),
          part("law", interface_behaviours, "law or cone of the interface").optional(),
          text("interface", "interface that takes the law; absent: all").optional(),
          part("method", contact_methods, "contact method").optional(), part("impact", impact_rules, "impact rule").optional(),
          part("scheme", schemes, "time integration of the dynamic stages").optional(),
          choice("traction", {"path", "end"}, "traction of the dynamic stages").optional(),
          number("step", "s", "time step of the dynamic stages").positive().optional(),
          choice("expected", {"completes", "may_fail"},
                 "may_fail: a failure is shown and marked, but does not fail the command; the run is not counted as sound")
              .standard("completes")}};
  return s;
}

CaseVariant case_variant(const Values& table) {
  const auto part = [&](const char* key) { return table.given(key) ? &table.part(key) : nullptr; };
  CaseVariant variant{{&table},
                      name_used(table, "name"),
                      text_or(table, "label", table.text("name")),
                      name_if(table, "case"),
                      part("law"),
                      part("method"),
                      part("impact"),
                      part("scheme"),
                      text_or(table, "interface", ""),
                      {},
                      number_if(table, "step"),
                      table.text("expected") == "may_fail"};
  if (table.has("traction")) variant.path_average = table.text("traction") == "path";
  if (variant.other_case)
    for (const char* key : {"law", "interface", "method", "impact", "scheme", "traction", "step"})
      if (table.given(key)) fail(table, key, "nothing beside another case, which states all itself", "a value");
  return variant;
}

const Section& compare_section() {
  static const Section s{"compare", "how variants are compared",
                         Fields{number("band", "1", "runs that passed all checks agree when they differ from their median by less")
                                    .positive()
                                    .standard(agreement_band),
                                texts("agree_on", "columns whose peaks are compared; absent: every number of the verdict").optional(),
                                tables("damping", damping_case_section(), "every variant is run with each of these"),
                                tables("motion", compare_motion_section(),
                                       "further motions: every variant is run with each of these and with that of the case"),
                                table("stiffness_sweep", sweep_section(), "a table of energy error against stiffness").optional()}};
  return s;
}

CaseComparison case_comparison(const Values& table) {
  CaseComparison made{table.number("band"), names_used(table, "agree_on"), {}, {}, {}};
  for (const Values& damping : table.tables("damping")) made.dampings.push_back(case_damping(damping));
  for (const Values& motion : table.tables("motion")) made.motions.push_back(case_other_motion(motion));
  if (const Values* sweep = table_if(table, "stiffness_sweep")) made.sweep = case_sweep(*sweep);
  return made;
}

const Section& trust_section() {
  static const Section s{
      "trust", "for `uplift trust`: how far each choice of the computation is changed",
      Fields{number("stiffness_factor", "1",
                    "joints are computed this many times as stiff and as soft too; 1: not changed; absent: 10, and 2 for a footing on "
                    "fixed ground, whose joint is the soil itself: the factor is then what the stiffness of the soil is uncertain by")
                 .between(1, 1e6)
                 .optional(),
             integer("interior",
                     "stiffnesses between the case and each end that are computed too, in equal ratios; 0: only the ends are, and the "
                     "results say so")
                 .between(0, 1000)
                 .standard(0),
             number("mesh_factor", "1", "sizes of a made mesh are multiplied by this; 1: not changed").between(0.1, 1).standard(0.7),
             number("mesh_shift", "1", "the mesh around interface.cut is moved by this share of a cell, to both sides; 0: not moved")
                 .between(0, 0.45)
                 .standard(0.3),
             number("spectrum_band", "1", "a floor spectrum is reliable up to the frequency where its runs differ by more than this share")
                 .positive()
                 .standard(0.1)}};
  return s;
}

CaseTrust case_trust(const Values& table) {
  return {number_if(table, "stiffness_factor"), table.integer("interior"), table.number("mesh_factor"), table.number("mesh_shift"),
          table.number("spectrum_band")};
}

const Section& origin_section() {
  static const Section s{"origin", "where values come from, shown with the results",
                         Fields{text("label", "for example \"paper\" or \"our choice\""),
                                texts("keys", "\"beam.column.E\", a whole table \"beam.column\", or \"*\" for all others"),
                                text("note", "source or reason").optional()}};
  return s;
}

CaseOrigin case_origin(const Values& table) {
  return {table.text("label"), table.texts("keys"), text_or(table, "note", "")};
}

const Section& figure_section() {
  static const Section s{"figure", "where a figure of the report comes from",
                         Fields{text("chart", "identifier of the figure"), text("origin", "for example \"paper, figure 5a\""),
                                text("caption", "replaces the caption").optional()}};
  return s;
}

CaseFigure case_figure(const Values& table) {
  return {table.text("chart"), table.text("origin"), table.has("caption") ? std::optional(table.text("caption")) : std::nullopt};
}

}  // namespace uplift
