#include "uplift/io/results/soil.h"

#include <fmt/format.h>

#include <filesystem>

#include "uplift/base/format.h"
#include "uplift/base/text.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"
#include "uplift/cli/words.h"
#include "uplift/laws/foundation.h"
#include "uplift/laws/soil_bed.h"

namespace uplift::cli {
namespace {

constexpr const char* soil_words = "uplift soil";

const Section& words_section() {
  static const Section section = [] {
    Section made{"footing",
                 "a rigid footing and its ground",
                 {choice("shape", {"strip", "rectangle", "disc"}, "plan of the underside").standard("rectangle"),
                  number("width", "m", "width of the underside; of a disc its diameter").positive(),
                  number("length", "m", "across the width; of a strip out of the plane, absent: 1 m").positive().optional()}};
    for (const Field& field : footing_soil_section().fields) made.fields.push_back(field);
    return made;
  }();
  return section;
}

FootingOnSoil footing_of_words(const std::vector<std::string>& given) {
  Words words;
  for (const std::string& word : given) words.push_back(word_of(word, soil_words));
  refuse_twice(words, soil_words);
  for (const auto& [key, value] : words)
    if (key == "radius" || key == "diameter")
      throw InputError({soil_words, 0}, key, "width, which is the diameter of a disc", in_quotes(key), "width");
  const Values values = check(table_of(std::move(words), soil_words), words_section());
  Footprint footprint;
  footprint.shape = *footprint_shape(values.text("shape"));
  footprint.width = values.number("width");
  const bool disc = footprint.shape == Footprint::Shape::disc, strip = footprint.shape == Footprint::Shape::strip;
  if (disc && values.has("length")) fail(values, "length", "no length: the width of a disc is its diameter", "one");
  if (!disc && !strip && !values.has("length")) fail(values, "", "the length of a rectangle", "none");
  footprint.length = disc ? footprint.width : values.has("length") ? values.number("length") : 1;
  return footing_on_soil(values, footprint);
}

bool is_rotation(SoilMotion motion) {
  return motion >= SoilMotion::tilting_width;
}

void print_springs(const FootingOnSoil& footing, const SoilSprings& springs) {
  const bool layered = footing.layers.size() > 1, embedded = footing.embedment > 0, dynamic = footing.frequency > 0;
  std::vector<std::vector<std::string>> rows{{"motion"}};
  const auto head = [&](bool shown, const char* name) {
    if (shown) rows.front().emplace_back(name);
  };
  head(layered, "mean G"), head(layered, "down to"), head(embedded || dynamic, "at the surface"), head(embedded, "embedment");
  head(dynamic, "frequency"), head(true, "stiffness"), head(true, "dashpot");
  for (const SoilMotion motion : soil_motions) {
    const SoilSpring& s = springs[motion];
    if (s.at_surface == 0) continue;
    const char* unit = is_rotation(motion) ? "N m/rad" : "N/m";
    std::vector<std::string> row{std::string(to_string(motion))};
    if (layered) row.push_back(format_quantity(s.ground.shear_modulus, "Pa")), row.push_back(format_quantity(s.depth, "m"));
    if (embedded || dynamic) row.push_back(format_quantity(s.at_surface, unit));
    if (embedded) row.push_back(fmt::format("x {:.3f}", s.embedment));
    if (dynamic) row.push_back(fmt::format("x {:.3f}", s.dynamic));
    row.push_back(format_quantity(s.stiffness(), unit));
    row.push_back(s.damping > 0 ? format_quantity(s.damping, is_rotation(motion) ? "N m s/rad" : "N s/m") : "-");
    rows.push_back(std::move(row));
  }
  print_table(rows);
  say("source: " + std::string(source_of(footing.formulas)));
  if (footing.formulas == SoilFormulas::strip) say(fmt::format("Of a length of {:g} m.", footing.length));
  if (springs[SoilMotion::vertical].ground.density == 0 && footing.formulas != SoilFormulas::strip)
    say("Without a density, there are no dashpots.");
  else if (footing.formulas == SoilFormulas::pais_kausel && !dynamic)
    say("Without a frequency, the rotations have no dashpots.");
}

/// What a joint of points can have of it, and what not. See docs/theory/soil_stiffness.md, eq (H13).
void print_bed(const FootingOnSoil& footing, const SoilSprings& springs, double area) {
  using enum SoilMotion;
  say("\nAs an [[interface]] of springs with the vertical stiffness:");
  const auto per_area = [&](double value, const char* unit) { return fmt::format("{:.6g} {}", value / area, unit); };
  say("  K_n = " + per_area(springs[vertical].stiffness(), "Pa/m") + ", K_t = " + per_area(springs[along_width].stiffness(), "Pa/m") +
      (springs[vertical].damping > 0 ? ", c = " + per_area(springs[vertical].damping, "Pa s/m") : ""));
  for (const SoilMotion rocking : {tilting_width, tilting_length}) {
    if (springs[rocking].at_surface == 0) continue;
    const double share = share_of_uniform_bed(footing, springs, rocking);
    say(fmt::format("  {}: {:.0f} % of the stiffness above; with K_n = {} all of it, and {:.0f} % of the vertical stiffness",
                    to_string(rocking), 100 * share, per_area(springs[vertical].stiffness() / share, "Pa/m"), 100 / share));
  }
  say("A uniform bed has either the vertical or the rocking stiffness; a [[foundation]] has both.");
  if (footing.formulas == SoilFormulas::disc) return;
  say("A bed that is stiffer towards the edges ([interface.footing.soil]; K_n, K_t = \"soil\"):");
  for (const SoilMotion rocking : {tilting_width, tilting_length}) {
    if (springs[rocking].at_surface == 0) continue;
    const double ratio = 1 / share_of_uniform_bed(footing, springs, rocking);
    const std::optional<BedProfile> profile = bed_profile(ratio);
    say(profile ? fmt::format("  {}: {:.3g} times the mean at the edge, {:.3g} in the middle; uplift begins at M = {:.2f} N D",
                              to_string(rocking), profile->edge, profile->middle, ratio / 6)
                : fmt::format("  {}: none ({:.2f} times the rocking stiffness of a uniform bed; at most 3 with all of it at the edges)",
                              to_string(rocking), ratio));
  }
}

void print_model(const SoilSprings& springs, bool plane) {
  using enum SoilMotion;
  say("\nIn the model of a [[foundation]]:");
  const auto line = [&](const char* key, SoilMotion motion) {
    if (springs[motion].at_surface > 0)
      say(fmt::format("  {} = \"{:.9g} {}\"", key, springs[motion].stiffness(), is_rotation(motion) ? "N m/rad" : "N/m"));
  };
  line("K_v", vertical), line("K_h", along_width), line("K_r", tilting_width);
  if (!plane) line("K_h2", along_length), line("K_r2", tilting_length), line("K_t", torsion);
}

void print(const FootingOnSoil& footing) {
  const SoilSprings springs = soil_springs(footing);
  print_springs(footing, springs);
  print_model(springs, footing.formulas == SoilFormulas::strip);
  print_bed(footing, springs, footing_area(footing));
}

void print_json(const std::vector<std::pair<std::string, FootingOnSoil>>& footings) {
  JsonWriter json(0, 2);
  json.begin_object().key("footings").begin_array();
  for (const auto& [name, footing] : footings) {
    json.begin_object().member("name", name);
    ResultWriter out(json);
    write_soil(out, footing);
    write_bed(out, footing);
    json.end_object();
  }
  json.end_array().end_object();
  say(json.take());
}

std::vector<std::pair<std::string, FootingOnSoil>> footings_of_case(const Options& options) {
  const LoadedCase loaded = load(options);
  const BuiltCase built = build(loaded.read, runs_of_case(loaded.read).front());
  std::vector<std::pair<std::string, FootingOnSoil>> footings;
  for (const InterfaceFacts& facts : built.facts)
    if (facts.soil) footings.emplace_back(facts.name, *facts.soil);
  if (footings.empty())
    throw InputError({options.file, 0}, "", "a [[foundation]] with [foundation.soil], or [interface.footing.soil]", "none");
  return footings;
}

}  // namespace

int soil(const Options& options, const std::vector<std::string>& words) {
  const bool described = words.front().find('=') != std::string::npos && !std::filesystem::exists(words.front());
  if (!described && words.size() > 1) throw InputError({soil_words, 0}, "", "one case, or KEY=VALUE words", in_quotes(words[1]));
  Options of_case = options;
  of_case.file = words.front();
  const auto footings =
      described ? std::vector<std::pair<std::string, FootingOnSoil>>{{"footing", footing_of_words(words)}} : footings_of_case(of_case);
  if (options.json) {
    print_json(footings);
    return Exit::done;
  }
  for (const auto& [name, footing] : footings) {
    if (footings.size() > 1) say((name == footings.front().first ? "" : "\n") + name);
    print(footing);
  }
  return Exit::done;
}

}  // namespace uplift::cli
