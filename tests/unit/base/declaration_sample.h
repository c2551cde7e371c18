#pragma once
#include "uplift/base/declare.h"

// A declaration with every kind of field, for the tests of the input.
namespace uplift {

inline std::span<const PartInfo* const> sample_methods() {
  static const PartInfo lagrange{"lagrange", "multipliers", "", "", {}};
  static const PartInfo penalty{
      "penalty",
      "springs",
      "p = k g",
      "",
      {number("stiffness", "Pa/m", "penalty").positive(), integer("rounds", "rounds").between(0, 100).standard(10)}};
  static const PartInfo* const list[] = {&lagrange, &penalty};
  return list;
}

inline const Section& sample_section() {
  static const Section beam{
      "beam",
      "a beam",
      {texts("nodes", "end nodes").optional(), number("E", "Pa", "Young's modulus").positive(),
       number("stiffness", "1", "factor").between(0, 10).or_word("rigid").standard(5.0), part("law", sample_methods, "law").optional()}};
  static const Section limits{
      "limits",
      "limits",
      {number("rotation", "rad", "largest rotation").nonnegative().standard(0.15), number("tolerance", "m", "tolerance").optional()}};
  static const Section node{"node", "a node", {numbers("value", "m", "position [x, y]", 2)}};
  static const Section one_case{"case", "a case", {number("factor", "1", "factor")}};
  static const Section damping{"damping", "damping", {number("slope", "1", "slope").negative(), tables("pair", one_case, "pairs")}};
  static const Section section{
      "sample",
      "every kind",
      {text("title", "title"), integer("count", "a count").between(1, 10).standard(7), integer("frames", "frames").optional(),
       flag("on", "a switch").standard(false), choice("rule", {"nodal", "midpoint", "gauss"}, "a rule").standard("nodal"),
       numbers("gravity", "m/s2", "acceleration", 2).optional(), texts("keys", "keys").optional(),
       part("method", sample_methods, "method").standard("lagrange"), named("nodes", node, "nodes"), named("cases", one_case, "cases"),
       table("limits", limits, "limits"), table("damping", damping, "damping").optional(), tables("beam", beam, "beams")}};
  return section;
}

}  // namespace uplift
