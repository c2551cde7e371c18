#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "property/random_parts.h"
#include "uplift/elements/bulk_law.h"
#include "uplift/math/dense.h"

// Properties of every bulk law in the catalog. Parameters are drawn from the law's own declaration, so that a new law is tested before its
// author writes a test.
namespace uplift::bulk_laws_test {
using namespace random_parts;
namespace {

double usual(std::string_view unit_name) {
  if (unit_name == "Pa") return magnitude(1e3, 1e6);
  if (unit_name == "rad") return between(0, 0.8);
  return unit();
}

/// The material properties of the behaviours that the law `mfront` is tested with (tests/mfront_behaviours.c), as parameters.
const PartInfo& behaviour(bool hardens) {
  static const PartInfo kinematic{
      "Prager", "", "", "", {number("YieldStrength", "Pa", "").positive(), number("HardeningSlope", "Pa", "").nonnegative()}};
  static const PartInfo cone{"DruckerPrager",
                             "",
                             "",
                             "",
                             {number("Cohesion", "Pa", "").nonnegative(), number("FrictionAngle", "rad", "").between(0, 1.5),
                              number("DilatancyAngle", "rad", "").between(0, 1.5), number("HardeningSlope", "Pa", "").nonnegative()}};
  return hardens ? kinematic : cone;
}

struct Law {
  const PartInfo* drawn;  // whose parameters were drawn
  std::vector<Parameter> parameters;
  ElasticMaterial material;
  std::shared_ptr<const BulkLaw> law;
};

std::shared_ptr<const BulkLaw> make_law(const BulkLawEntry& entry, const PartInfo& drawn, const ElasticMaterial& material,
                                        const std::vector<Parameter>& parameters) {
  const auto text = [](const std::string& value) { return Raw{value, {}, "law"}; };
  auto table = std::make_shared<RawTable>(), drawn_table = &entry == &drawn ? table : std::make_shared<RawTable>();
  table->entries.emplace_back("type", text(std::string(entry.name)));
  if (&entry != &drawn) {
    table->entries.emplace_back("library", text(UPLIFT_MFRONT_LIBRARY));
    table->entries.emplace_back("behaviour", text(std::string(drawn.name)));
  }
  for (const auto& [key, value] : parameters)
    std::visit([&, &name = key](const auto& given) { drawn_table->entries.emplace_back(name, Raw{given, {}, "law." + name}); }, value);
  if (&entry != &drawn) table->entries.emplace_back("properties", Raw{drawn_table, {}, "law.properties"});
  return make_part(bulk_law_catalog(), check_part(Raw{table, {}, "law"}, bulk_laws()), {material, 3});
}

Law random_law(const BulkLawEntry& entry) {
  const ElasticMaterial material{magnitude(1e7, 1e10), between(0.05, 0.45), 2000};
  const PartInfo& drawn = entry.name == "mfront" ? behaviour(one_in(2)) : entry;
  return random_part<Law>(drawn, usual, [&](const std::vector<Parameter>& parameters) {
    return Law{&drawn, parameters, material, make_law(entry, drawn, material, parameters)};
  });
}

void for_each_law(const std::function<void(const BulkLawEntry&, const Law&)>& property) {
  for (const BulkLawEntry* entry : bulk_law_catalog()) property(*entry, random_law(*entry));
}

Strain random_strain(double size) {
  Strain strain;
  for (double& each : strain) each = size * between(-1, 1);
  return strain;
}

/// One point with its memory.
struct Point {
  explicit Point(const Law& of) : law(*of.law), old(static_cast<std::size_t>(law.num_history()), 0.0), now(old) {}

  /// Stress of a step to this strain; `old` stays.
  const Stress& respond(const Strain& at) {
    const BulkResponse response = law.respond({{&at, 1}, old.data(), now.data(), &stress, &tangent});
    RC_ASSERT(response.converged);
    return stress;
  }
  /// Goes there; returns the work of the stress at the end of the step less the change of the energy [J/m3].
  double go(const Strain& to) {
    const double before = energy();
    respond(to);
    const double work = stress.dot(to - strain);
    old = now;
    strain = to;
    return work - (energy() - before);
  }
  /// Recoverable and locked energy of `old` at `strain` [J/m3].
  double energy() const {
    const Strain recoverable = strain - ConstMap(old.data(), 6);
    return recoverable.dot(law.elastic() * recoverable) / 2 + law.locked_energy(old.data());
  }
  bool changed() const { return !std::equal(old.begin(), old.begin() + 6, now.begin()); }

  const BulkLaw& law;
  std::vector<double> old, now;
  Strain strain = Strain::Zero();
  Stress stress = Stress::Zero();
  Mat6 tangent = Mat6::Zero();
};

/// A point with a random past of up to five steps.
Point random_point(const Law& law, double size) {
  Point point(law);
  for (int past = integer_in(0, 6); past > 0; --past) point.go(random_strain(size));
  return point;
}

double random_size() {
  return magnitude(1e-5, 1e-2);
}

RC_GTEST_PROP(BulkLawProperties, StressIsThatOfTheElasticMaterialForTheStrainLessTheInelasticOne, ()) {
  for_each_law([](const BulkLawEntry& entry, const Law& law) {
    const double size = random_size();
    Point point = random_point(law, size);
    const Strain to = random_strain(size);
    point.respond(to);
    const Stress expected = law.law->elastic() * (to - ConstMap(point.now.data(), 6));
    const double scale = law.material.constrained() * (size + ConstMap(point.now.data(), 6).norm());
    if (!((point.stress - expected).norm() <= 1e-13 * scale)) RC_FAIL(shown(entry, law.parameters) + ": stress is not D (strain - e)");
  });
}

/// d stress/d strain component by differences of fourth order; nothing where two steps disagree (a kink is near).
std::optional<Stress> difference(Point& point, const Strain& to, int component, double h) {
  const auto quotient = [&](double step) -> Stress {
    const auto at = [&](double shift) -> Stress {
      Strain moved = to;
      moved[component] += shift;
      return point.respond(moved);
    };
    return (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step);
  };
  const Stress coarse = quotient(h), fine = quotient(0.5 * h);
  if ((coarse - fine).norm() > 1e-7 * point.law.material().constrained()) return std::nullopt;
  return fine;
}

RC_GTEST_PROP(BulkLawProperties, TangentIsTheDerivativeOfTheUpdate, ()) {
  int all = 0, smooth = 0;
  for (int set = 0; set < 10; ++set)
    for_each_law([&](const BulkLawEntry& entry, const Law& law) {
      const double size = random_size();
      Point point = random_point(law, size);
      const Strain to = random_strain(size);
      for (int component = 0; component < 6; ++component) {
        ++all;
        const auto expected = difference(point, to, component, 1e-3 * size);
        if (!expected) continue;
        ++smooth;
        point.respond(to);
        if (!((point.tangent.col(component) - *expected).norm() <= 1e-6 * law.material.constrained()))
          RC_FAIL(shown(entry, law.parameters) + ": column " + std::to_string(component) + " of the tangent is not the derivative");
      }
    });
  RC_ASSERT(smooth > 0.8 * all);
}

// With an implicit update the stress at the end of the step does at least the work that is stored: for the recoverable energy, which is
// convex, sigma_1 . (e_1 - e_0) >= psi(e_1) - psi(e_0), and the flow dissipates. The sum over a closed path is the energy that it takes.
RC_GTEST_PROP(BulkLawProperties, NoStepAndNoClosedPathGivesEnergy, ()) {
  for_each_law([](const BulkLawEntry& entry, const Law& law) {
    const double size = random_size();
    Point point = random_point(law, size);
    const Strain start = point.strain;
    const double before = point.energy();
    double lost = 0, scale = before;
    std::vector<Strain> corners;
    for (int i = 0; i < 6; ++i) corners.push_back(random_strain(size));
    corners.push_back(start);
    for (int round = 0; round < 2; ++round)
      for (const Strain& to : corners) {
        const Strain from = point.strain;
        scale = std::max(scale, law.material.constrained() * size * size);
        const double part = point.go(to);
        lost += part;
        if (!(part >= -1e-12 * scale)) RC_FAIL(shown(entry, law.parameters) + ": a step gave energy");
        RC_ASSERT(point.energy() >= -1e-12 * scale);
        RC_ASSERT((to - from).allFinite());
      }
    if (!(lost >= -1e-11 * scale)) RC_FAIL(shown(entry, law.parameters) + ": a closed path gave energy");
  });
}

RC_GTEST_PROP(BulkLawProperties, TheElasticLimitIsTheElasticMaterial, ()) {
  for_each_law([](const BulkLawEntry& entry, const Law& law) {
    Point natural(law);
    RC_ASSERT(natural.respond(Strain::Zero()).isZero(0));
    for (const double value : natural.now) RC_ASSERT(value == 0);
    // a step that changes no inelastic strain is elastic, and most steps back are
    const double size = random_size();
    Point point = random_point(law, size);
    point.go(random_strain(size));
    int elastic = 0;
    for (int trial = 0; trial < 20; ++trial) {
      const Strain to = point.strain - 1e-3 * size * between(0.1, 1) * point.stress / std::max(point.stress.norm(), 1e-300);
      const Stress before = point.stress;
      point.respond(to);
      if (point.changed()) continue;
      ++elastic;
      const double scale = law.material.constrained() * size;
      const Stress expected = law.law->elastic() * (to - ConstMap(point.now.data(), 6));
      if (!((point.stress - expected).norm() <= 1e-12 * scale)) RC_FAIL(shown(entry, law.parameters) + ": an elastic step is not elastic");
      if (!((point.tangent - law.law->elastic()).norm() <= 1e-12 * law.law->elastic().norm()))
        RC_FAIL(shown(entry, law.parameters) + ": the tangent of an elastic step is not the elastic stiffness");
      point.stress = before;
    }
    if (law.law->linear()) RC_ASSERT(elastic == 20);
  });
}

/// Rows of a tensor in the order of Strain, with half of the engineering shear strains.
Mat3 tensor(const Vec6& v, double shear) {
  Mat3 t;
  t << v[0], shear * v[3], shear * v[5], shear * v[3], v[1], shear * v[4], shear * v[5], shear * v[4], v[2];
  return t;
}
Vec6 listed(const Mat3& t, double shear) {
  Vec6 v;
  v << t(0, 0), t(1, 1), t(2, 2), t(0, 1) / shear, t(1, 2) / shear, t(2, 0) / shear;
  return v;
}

RC_GTEST_PROP(BulkLawProperties, AxesPlayNoPart, ()) {
  for_each_law([](const BulkLawEntry& entry, const Law& law) {
    const double size = random_size(), a = between(0, 6.3), b = between(0, 3.1);
    Mat3 about_z = Mat3::Identity(), about_x = Mat3::Identity();
    about_z.topLeftCorner<2, 2>() << std::cos(a), -std::sin(a), std::sin(a), std::cos(a);
    about_x.bottomRightCorner<2, 2>() << std::cos(b), -std::sin(b), std::sin(b), std::cos(b);
    const Mat3 turn = about_x * about_z;
    Point point(law), turned(law);
    for (int step = 0; step < 5; ++step) {
      const Strain strain = random_strain(size);
      point.go(strain);
      turned.go(listed(turn * tensor(strain, 0.5) * turn.transpose(), 0.5));
      const Stress expected = listed(turn * tensor(point.stress, 1) * turn.transpose(), 1);
      if (!((turned.stress - expected).norm() <= 1e-10 * law.material.constrained() * size))
        RC_FAIL(shown(entry, law.parameters) + ": the stress depends on the axes");
    }
  });
}

RC_GTEST_PROP(BulkLawProperties, UnitsScale, ()) {
  for_each_law([](const BulkLawEntry& entry, const Law& law) {
    const double pressure = std::exp2(integer_in(-9, 10)), size = random_size();
    std::vector<Parameter> scaled = law.parameters;
    for (auto& [key, value] : scaled) {
      double* number = std::get_if<double>(&value);
      if (number == nullptr) continue;
      const std::vector<Field>& fields = law.drawn->params;
      const auto field = std::find_if(fields.begin(), fields.end(), [&key = key](const Field& f) { return f.name == key; });
      if (field->unit == "Pa")
        *number *= pressure;
      else
        RC_ASSERT(field->unit == std::string_view("1") || field->unit == std::string_view("rad"));
    }
    Law other = law;
    other.material.young *= pressure;
    other.law = make_law(entry, *law.drawn, other.material, scaled);
    Point one(law), two(other);
    for (int step = 0; step < 5; ++step) {
      const Strain to = random_strain(size);
      const double lost = one.go(to), lost_there = two.go(to), scale = other.material.constrained() * size;
      if (!((one.stress * pressure - two.stress).norm() <= 1e-12 * scale)) RC_FAIL(shown(entry, law.parameters) + ": units do not scale");
      RC_ASSERT(std::abs(lost * pressure - lost_there) <= 1e-12 * scale * size);
    }
  });
}

RC_GTEST_PROP(BulkLawProperties, ABatchIsItsPoints, ()) {
  for_each_law([](const BulkLawEntry& entry, const Law& law) {
    const auto count = static_cast<std::size_t>(integer_in(1, 28)), size = static_cast<std::size_t>(law.law->num_history());
    const double amplitude = random_size();
    std::vector<Point> single(count, Point(law));
    std::vector<double> old(count * size, 0.0), now = old;
    std::vector<Strain> strain(count);
    std::vector<Stress> stress(count);
    std::vector<Mat6> tangent(count);
    for (int step = 0; step < 3; ++step) {
      for (Strain& each : strain) each = random_strain(amplitude);
      const bool tangents = one_in(2);
      RC_ASSERT(law.law->respond({strain, old.data(), now.data(), stress.data(), tangents ? tangent.data() : nullptr}).converged);
      for (std::size_t p = 0; p < count; ++p) {
        single[p].go(strain[p]);
        RC_ASSERT((single[p].stress - stress[p]).norm() <= 1e-14 * law.material.constrained() * amplitude);
        if (tangents && (single[p].tangent - tangent[p]).norm() > 1e-14 * law.law->elastic().norm())
          RC_FAIL(shown(entry, law.parameters) + ": tangent of point " + std::to_string(p));
        for (std::size_t h = 0; h < size; ++h)
          RC_ASSERT(std::abs(single[p].old[h] - now[p * size + h]) <= 1e-14 * std::max(amplitude, std::abs(now[p * size + h])));
      }
      old = now;
    }
  });
}

RC_GTEST_PROP(BulkLawProperties, OutputsHaveNamesUnitsAndFiniteValues, ()) {
  for_each_law([](const BulkLawEntry&, const Law& law) {
    std::set<std::string_view> names{"displacement", "velocity", "acceleration", "stress", "section_forces"};
    for (const BulkOutput& output : law.law->outputs()) {
      RC_ASSERT(!output.name.empty() && !output.unit.empty());
      RC_ASSERT(names.insert(output.name).second);
    }
    const Point point = random_point(law, random_size());
    std::vector<double> values(law.law->outputs().size(), std::numeric_limits<double>::quiet_NaN());
    law.law->find_outputs(point.old.data(), values.data());
    for (const double value : values) RC_ASSERT(std::isfinite(value));
  });
}

}  // namespace
}  // namespace uplift::bulk_laws_test
