#include "uplift/io/results/soil.h"

#include "uplift/laws/soil_bed.h"

namespace uplift {

void write_soil(ResultWriter& out, const FootingOnSoil& footing) {
  struct Row {
    SoilMotion motion = SoilMotion::vertical;
    SoilSpring spring;
  };
  std::vector<Row> rows;
  if (!out.is_schema()) {
    const SoilSprings springs = soil_springs(footing);
    for (const SoilMotion motion : soil_motions)
      if (springs[motion].at_surface > 0) rows.push_back({motion, springs[motion]});
  }
  out.object("soil", "stiffness of the ground under the footing, from published formulas", [&] {
    out.text("source", source_of(footing.formulas), "where the formulas come from");
    out.number("embedment", footing.embedment, "m", "depth of the underside");
    out.number("frequency", footing.frequency, "Hz", "of the dynamic factors and of the dashpots of rotations; 0: static");
    out.flag("radiation", footing.radiation, "whether the dashpots are part of the model");
    out.list("motions", "translations [N/m, N s/m], then rotations [N m/rad, N m s/rad]", rows, [&](const Row& row) {
      const SoilSpring& spring = row.spring;
      out.text("motion", to_string(row.motion), "direction");
      out.number("shear_modulus", spring.ground.shear_modulus, "Pa", "of homogeneous ground that stands for the layers");
      out.number("depth", spring.depth, "m", "below the underside: the layers down to here count");
      out.number("at_surface", spring.at_surface, "N/m or N m/rad", "static stiffness on the surface");
      out.number("embedment_factor", spring.embedment, "1", "factor of the embedment");
      out.number("dynamic_factor", spring.dynamic, "1", "factor of the frequency");
      out.number("stiffness", spring.stiffness(), "N/m or N m/rad", "the product");
      out.number("damping", spring.damping, "N s/m or N m s/rad", "dashpot of the radiated waves; 0: no formula, or no density");
    });
  });
}

void write_bed(ResultWriter& out, const FootingOnSoil& footing) {
  using enum SoilMotion;
  const SoilSprings springs = soil_springs(footing);
  const double area = footing_area(footing);
  std::vector<SoilMotion> tiltings;
  for (const SoilMotion tilting : {tilting_width, tilting_length})
    if (springs[tilting].at_surface > 0) tiltings.push_back(tilting);
  out.object("bed", "springs per area of an [[interface]] for this ground", [&] {
    out.number("K_n", springs[vertical].stiffness() / area, "Pa/m", "normal stiffness with the vertical stiffness of the ground");
    out.number("K_t", springs[along_width].stiffness() / area, "Pa/m", "tangential stiffness along the width");
    out.number("c", springs[vertical].damping / area, "Pa s/m", "normal dashpot; 0: no formula, or no density");
    out.list("rocking", "rotations of the footing", tiltings, [&](SoilMotion tilting) {
      const double share = share_of_uniform_bed(footing, springs, tilting);
      const auto profile = footing.formulas == SoilFormulas::disc ? std::nullopt : bed_profile(1 / share);
      out.text("motion", to_string(tilting), "direction");
      out.number("uniform_share", share, "1", "rocking stiffness of the uniform bed over that of the ground");
      out.number("uniform_K_n", springs[vertical].stiffness() / area / share, "Pa/m",
                 "uniform normal stiffness with the rocking stiffness");
      out.number_or_null("edge", profile ? std::optional(profile->edge) : std::nullopt, "1",
                         "stiffness at the edge over the mean, of the bed with both stiffnesses; null: there is none");
      out.number_or_null("middle", profile ? std::optional(profile->middle) : std::nullopt, "1", "the same in the middle");
    });
  });
}

}  // namespace uplift
