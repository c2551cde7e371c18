#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "uplift/base/text.h"
#include "uplift/base/units.h"
#include "uplift/elements/bulk_law.h"
#include "uplift/elements/bulk_laws/mfront_library.h"

// A law that MFront compiled to a shared library. The library answers stresses; the inelastic strain of the program's form,
//   stress = D (strain - e),   follows as   e = strain - D^-1 stress,
// and the locked energy is what the library states as stored less (strain - e).D (strain - e)/2, where it states any; else it is zero.
// Memory of a point: e, strain, locked energy, internal state variables less their values in the natural state.
namespace uplift {
namespace {

constexpr int strain_at = 6, locked_at = 12, variables_at = 13;
/// Stresses that differ by this share of M |strain| (M: constrained modulus) are the same: what a library rounds is no inelastic strain.
constexpr double round_off = 1e-13;
constexpr double temperature = 293.15;  // K
constexpr double consistent_tangent = 4, no_tangent = 0;

/// MFront's order is xx, yy, zz, xy, xz, yz, the program's xx, yy, zz, xy, yz, zx.
constexpr std::array<int, 6> place{0, 1, 2, 3, 5, 4};
/// Factor on stresses; its inverse is that on engineering strains.
constexpr double factor(int component) {
  return component < 3 ? 1 : std::numbers::sqrt2;
}

class MfrontLaw final : public BulkLaw {
 public:
  MfrontLaw(const ElasticMaterial& material, MfrontBehaviour behaviour, std::vector<double> properties, std::vector<double> natural)
      : BulkLaw(material), behaviour_(std::move(behaviour)), properties_(std::move(properties)), natural_(std::move(natural)) {
    int first = variables_at;
    for (const MfrontVariable& each : behaviour_.variables) {
      if (each.size == 1) {
        outputs_.push_back({each.name, "SI"});
        outputs_at_.push_back(first);
      }
      first += each.size;
    }
  }

  int num_history() const override { return variables_at + static_cast<int>(natural_.size()); }

  BulkResponse respond(const BulkPoints& points) const override {
    std::vector<double> before(natural_.size()), after(natural_.size());
    const int size = num_history();
    for (int p = 0; p < static_cast<int>(points.strain.size()); ++p) {
      BulkResponse response = respond(points, p, points.old + size * p, points.now + size * p, before, after);
      if (!response.converged) return response;
    }
    return {};
  }

  double locked_energy(const double* history) const override { return history[locked_at]; }
  std::span<const BulkOutput> outputs() const override { return outputs_; }
  void find_outputs(const double* history, double* values) const override {
    for (std::size_t k = 0; k < outputs_at_.size(); ++k) {
      const int at = outputs_at_[k];
      values[k] = natural_[static_cast<std::size_t>(at - variables_at)] + history[at];
    }
  }

 private:
  BulkResponse respond(const BulkPoints& points, int p, const double* old, double* now, std::vector<double>& before,
                       std::vector<double>& after) const {
    const Strain& strain = points.strain[static_cast<std::size_t>(p)];
    const Strain elastic_before = ConstMap(old + strain_at, 6) - ConstMap(old, 6);
    for (std::size_t k = 0; k < natural_.size(); ++k) after[k] = before[k] = natural_[k] + old[variables_at + static_cast<int>(k)];
    const bool tangent = points.tangent != nullptr;

    Step step;
    step.strain_before = packed(ConstMap(old + strain_at, 6), true), step.strain = packed(strain, true);
    step.stress_before = step.stress = packed(elastic() * elastic_before, false);
    step.stored_before = step.stored = recoverable(elastic_before) + old[locked_at];
    step.tangent[0] = tangent ? consistent_tangent : no_tangent;
    if (std::string why = integrate(step, points.duration, before, after); !why.empty()) return {false, std::move(why)};

    Stress stress = unpacked(step.stress, elastic() * strain);
    if (!stress.allFinite()) return {false, named() + "the stress is not finite"};
    const bool changed = remember(strain, stress, step.stored, old, now);
    if (tangent) points.tangent[p] = changed ? unpacked(step.tangent) : elastic();
    for (std::size_t k = 0; k < natural_.size(); ++k) now[variables_at + static_cast<int>(k)] = after[k] - natural_[k];
    points.stress[p] = stress;
    return {};
  }

  /// Room for the data of one step of one point, in MFront's order and factors.
  struct Step {
    std::array<double, 6> strain_before, strain, stress_before, stress;
    std::array<double, 36> tangent{};
    double stored_before = 0, stored = 0;
  };

  /// Calls the library. Returns why the step failed; empty: it did not.
  std::string integrate(Step& step, double duration, std::vector<double>& before, std::vector<double>& after) const {
    char message[mfront_message] = "";
    double dissipated_before = 0, dissipated = 0, step_factor = 1, speed_of_sound = 0;
    const double density = material().density;
    MfrontPoint point{
        message,
        duration,
        step.tangent.data(),
        &step_factor,
        &speed_of_sound,
        {step.strain_before.data(), step.stress_before.data(), &density, properties_.data(), before.data(), &step.stored_before,
         &dissipated_before, &temperature},
        {step.strain.data(), step.stress.data(), &density, properties_.data(), after.data(), &step.stored, &dissipated, &temperature}};
    const int answer = behaviour_.function(&point);
    if (answer == 1) return {};
    message[mfront_message - 1] = '\0';
    if (message[0] != '\0') return named() + message;
    return named() + (answer == 0 ? "it asks for a shorter step" : "the integration of the step failed");
  }
  std::string named() const { return "behaviour " + in_quotes(behaviour_.name) + " of MFront: "; }

  /// Fills e, strain and locked energy of `now`. Where e is that of the beginning but for round-off it stays, and the stress follows it;
  /// returns whether e changed.
  bool remember(const Strain& strain, Stress& stress, double stored, const double* old, double* now) const {
    const ConstMap e_before(old, 6);
    const Stress without_change = elastic() * (strain - e_before);
    const double scale = material().constrained() * (strain.cwiseAbs().maxCoeff() + e_before.cwiseAbs().maxCoeff());
    Map(now + strain_at, 6) = strain;
    if ((stress - without_change).cwiseAbs().maxCoeff() <= round_off * scale) {
      stress = without_change;
      std::copy_n(old, 6, now);
      now[locked_at] = old[locked_at];
      return false;
    }
    const Strain recovered = strain_of(stress);
    Map(now, 6) = strain - recovered;
    now[locked_at] = behaviour_.stores_energy ? stored - recoverable(recovered) : 0;
    return true;
  }

  double recoverable(const Strain& strain) const { return strain.dot(elastic() * strain) / 2; }
  /// D^-1 stress.
  Strain strain_of(const Stress& stress) const {
    const double young = material().young, poisson = material().poisson, trace = stress.head<3>().sum();
    Strain strain = stress / material().shear();
    strain.head<3>() = ((1 + poisson) * stress.head<3>().array() - poisson * trace) / young;
    return strain;
  }

  static std::array<double, 6> packed(const Vec6& tensor, bool is_strain) {
    std::array<double, 6> all;
    for (int k = 0; k < 6; ++k) all[at(k)] = is_strain ? tensor[place[at(k)]] / factor(k) : tensor[place[at(k)]] * factor(k);
    return all;
  }
  /// Components that the library leaves out in plane strain are those of `others`.
  Stress unpacked(const std::array<double, 6>& given, const Stress& others) const {
    Stress stress = others;
    for (int k = 0; k < behaviour_.components; ++k) stress[place[at(k)]] = given[at(k)] / factor(k);
    return stress;
  }
  Mat6 unpacked(const std::array<double, 36>& rows) const {
    const int n = behaviour_.components;
    Mat6 tangent = elastic();
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) tangent(place[at(i)], place[at(j)]) = rows[at(n * i + j)] / (factor(i) * factor(j));
    return tangent;
  }
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  MfrontBehaviour behaviour_;
  std::vector<double> properties_, natural_;  // natural_: internal state variables of the natural state
  std::vector<BulkOutput> outputs_;
  std::vector<int> outputs_at_;  // in the memory
};

/// A number with or without a unit: what it measures is known to the library alone.
double number_of(const Values& entry) {
  std::string nearest;
  for (const char* unit : {"1", "Pa", "rad", "s", "1/s", "m", "Pa s", "1/Pa", "kg/m3", "K"}) {
    const Quantity value = parse_quantity(entry.text("value"), unit);
    if (value.ok) return value.value;
    if (nearest.empty()) nearest = value.nearest;
  }
  fail(entry, "value", "a number, or a text with a number and its unit", in_quotes(entry.text("value")), nearest);
}

/// The material properties in the order of the library: Young's modulus and Poisson's ratio of the solid, the others of the case.
std::vector<double> properties_from(const Values& law, const MfrontBehaviour& behaviour, const ElasticMaterial& material) {
  static constexpr std::string_view young = "YoungModulus", poisson = "PoissonRatio";
  const std::vector<Values>& given = law.tables("properties");
  const auto of_solid = [](std::string_view name) { return name == young || name == poisson; };
  std::vector<std::string> names;
  std::ranges::copy_if(behaviour.properties, std::back_inserter(names), [&](const std::string& name) { return !of_solid(name); });
  for (const Values& each : given) {
    if (of_solid(each.key()))
      fail(law, "properties", each.key() + " from " + (each.key() == young ? "E" : "poisson") + " of the solid", "it among the properties");
    if (std::ranges::find(names, each.key()) == names.end())
      throw InputError(
          each.where(), each.path(),
          names.empty() ? "no material property except those of the solid" : "a material property of the behaviour: " + listed(names),
          in_quotes(each.key()), nearest_name(each.key(), names));
  }
  std::vector<double> values;
  for (const std::string& name : behaviour.properties) {
    const auto found = std::ranges::find(given, name, &Values::key);
    if (of_solid(name))
      values.push_back(name == young ? material.young : material.poisson);
    else if (found != given.end())
      values.push_back(number_of(*found));
    else
      fail(law, "properties", fmt::format("{} material properties: {}", names.size(), listed(names)), "no " + in_quotes(name));
  }
  return values;
}

/// Internal state variables of the natural state: those that the case states, else zero.
std::vector<double> natural_from(const Values& law, const MfrontBehaviour& behaviour) {
  std::vector<double> values(static_cast<std::size_t>(behaviour.num_variables()), 0.0);
  for (const Values& each : law.tables("state")) {
    std::vector<std::string> scalars;
    std::size_t at = 0;
    bool found = false;
    for (const MfrontVariable& variable : behaviour.variables) {
      if (variable.size == 1) scalars.push_back(variable.name);
      if (variable.size == 1 && variable.name == each.key()) values[at] = number_of(each), found = true;
      at += static_cast<std::size_t>(variable.size);
    }
    if (!found)
      throw InputError(each.where(), each.path(),
                       scalars.empty() ? "no state, as the behaviour has no scalar internal state variable"
                                       : "a scalar internal state variable of the behaviour: " + listed(scalars),
                       in_quotes(each.key()), nearest_name(each.key(), scalars));
  }
  return values;
}

/// A behaviour refuses parameters out of its bounds when it is called: here with the natural state, before the first step.
void check_natural_state(const Values& values, const BulkLaw& law) {
  const Strain none = Strain::Zero();
  const std::vector<double> natural(static_cast<std::size_t>(law.num_history()), 0.0);
  std::vector<double> now = natural;
  Stress stress;
  Mat6 tangent;
  const BulkResponse response = law.respond({{&none, 1}, natural.data(), now.data(), &stress, &tangent});
  if (!response.converged) fail(values, "behaviour", "a behaviour that accepts its parameters and the natural state", response.why);
  if (stress.cwiseAbs().maxCoeff() > 0)
    fail(values, "behaviour", "no stress in the natural state", fmt::format("{:.3g} Pa", stress.cwiseAbs().maxCoeff()));
  if (!tangent.allFinite()) fail(values, "behaviour", "a consistent tangent", "one that is not finite in the natural state");
}

std::unique_ptr<const BulkLaw> made(const BulkLawContext& solid, const Values& values) {
  MfrontBehaviour behaviour = load_mfront(values, solid.dimension);
  std::vector<double> properties = properties_from(values, behaviour, solid.material), natural = natural_from(values, behaviour);
  auto law = std::make_unique<MfrontLaw>(solid.material, std::move(behaviour), std::move(properties), std::move(natural));
  check_natural_state(values, *law);
  return law;
}

Field value_field() {
  Field field = text("value", "its value: a number in SI units, or a text with a number and its unit");
  field.unit = "*";
  return field;
}

const Section& property_section() {
  static const Section s{"properties", "material properties of the behaviour", {value_field()}};
  return s;
}

const Section& state_section() {
  static const Section s{"state", "internal state variables of the natural state", {value_field()}};
  return s;
}

}  // namespace

const BulkLawEntry& entry_bulk_law_mfront() {
  static const BulkLawEntry entry{
      {.name = "mfront",
       .summary = "a behaviour that MFront compiled to a shared library with its generic interface: small strains, isotropic. Its code is "
                  "executed: use libraries that you trust",
       .equations = "stress and tangent from the library\n"
                    "e = strain - D^-1 stress, D from E and poisson of the solid, which the library receives as YoungModulus and "
                    "PoissonRatio\n"
                    "stored energy: that of the library where it computes one (@InternalEnergy), else (strain - e).D (strain - e)/2",
       .source = "Helfer et al., The MFrontGenericInterfaceSupport project, J. Open Source Software 5 (2020) 2003; docs/theory, section 9",
       .params = {text("library", "path of the shared library, relative to the case file"), text("behaviour", "name of the behaviour"),
                  named("properties", property_section(),
                        "material properties by the names of the library, for example FrictionAngle = \"30 deg\"; YoungModulus and "
                        "PoissonRatio are those of the solid"),
                  named("state", state_section(),
                        "scalar internal state variables of the natural state by the names of the library; others are zero")}},
      made};
  return entry;
}

}  // namespace uplift
