#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <optional>
#include <random>

#include "property/random_parts.h"
#include "unit/elements/solid_support.h"
#include "uplift/elements/element_entry.h"
#include "uplift/math/dense.h"

// Properties of every element in the catalog, in the plane and in space, on every number of nodes that it takes. Parameters are drawn from
// its own declaration, so that a new element is tested before its author writes a test.
namespace uplift::elements_test {
using namespace random_parts;
namespace {

double usual(std::string_view) {
  return magnitude(1e2, 1e8);
}

struct Made {
  std::vector<Parameter> parameters;
  std::unique_ptr<const Element> element;
};

Vec3 random_vector(Space space) {
  return {between(-1, 1), between(-1, 1), space.dimension == 3 ? between(-1, 1) : 0};
}

/// The checked table of an element: its random numbers, `nodes` by name, and every list of numbers as a random vector.
Values table_of(const ElementEntry& entry, const std::vector<Parameter>& parameters, const ElementSite& site) {
  auto table = std::make_shared<RawTable>();
  for (const auto& [key, value] : parameters)
    std::visit([&, &name = key](const auto& given) { table->entries.emplace_back(name, Raw{given, {}, name}); }, value);
  for (const Field& field : entry.params) {
    const std::string name(field.name);
    if (field.kind == Kind::text && field.required) table->entries.emplace_back(name, Raw{std::string("element"), {}, name});
    if (field.kind == Kind::texts && name == "nodes") {
      RawList nodes;
      for (const int node : site.nodes) nodes.push_back(Raw{"n" + std::to_string(node), {}, name});
      table->entries.emplace_back(name, Raw{nodes, {}, name});
    }
    if (field.kind == Kind::numbers && (field.required || one_in(2))) {
      const Vec3 vector = random_vector(site.space);
      RawList numbers;
      for (int i = 0; i < site.space.dimension; ++i) numbers.push_back(Raw{vector[i], {}, name});
      table->entries.emplace_back(name, Raw{numbers, {}, name});
    }
  }
  static std::map<std::string_view, Section> sections;  // the values refer to their declaration
  const Section& section = sections.try_emplace(entry.name, Section{entry.name, entry.summary, entry.params}).first->second;
  return check(Raw{table, {}, std::string(entry.name)}, section);
}

ElementSite random_site(Space space, int nodes) {
  ElementSite site{space, {}, {}};
  for (int i = 0; i < nodes; ++i) {
    site.nodes.push_back(i);
    site.positions.push_back(random_vector(space) + 5 * i * Vec3::UnitX());
  }
  return site;
}

/// The sites that an element is tried on: one to four nodes, the ends of a line, or a distorted cell (face) of any kind.
std::vector<std::pair<ElementSite, Cell>> random_sites(ElementPlace place, Space space) {
  std::vector<std::pair<ElementSite, Cell>> sites;
  if (place == ElementPlace::nodes)
    for (int nodes = 1; nodes <= 4; ++nodes) sites.emplace_back(random_site(space, nodes), Cell::line2);
  if (place == ElementPlace::lines) sites.emplace_back(random_site(space, 2), Cell::line2);
  if (!sites.empty()) return sites;
  std::vector<CellInfo> kinds;
  for (const CellInfo& each : all_cells())
    if (each.dimension == space.dimension - (place == ElementPlace::faces)) kinds.push_back(each);
  const CellInfo& kind = kinds[static_cast<std::size_t>(integer_in(0, static_cast<int>(kinds.size())))];
  std::mt19937 random(static_cast<unsigned>(integer_in(0, 1000000)));
  sites.emplace_back(ElementSite{space, first_numbers(kind.nodes), distorted_nodes(kind.cell, 0.1, random)}, kind.cell);
  for (Vec3& position : sites.back().first.positions)
    if (space.dimension == 2) position.z() = 0;
  return sites;
}

/// Faces stand beside soil.
std::unique_ptr<const Element> make_element(const ElementEntry& entry, const Values& table, const ElementSite& site, Cell cell) {
  static const SolidSection soil{.material = {5e7, 0.3, 1900}};
  static const std::string group = "soil";
  const CellSite on_mesh{cell, site.nodes, std::make_shared<const std::vector<Vec3>>(site.positions)};
  if (entry.place == ElementPlace::cells) return entry.fill(table, site.space.dimension)->make(on_mesh);
  if (entry.place == ElementPlace::faces) return entry.cover(on_mesh, table, {soil, group}, site.space);
  return entry.make(site, table);
}

/// Runs a property for every element of the catalog on all sites; those that it never takes are left out.
void for_each_element(const std::function<void(const std::string&, const Element&, const ElementSite&)>& property,
                      std::optional<ElementPlace> except = {}) {
  for (const ElementEntry* entry : element_catalog()) {
    if (entry->place == except) continue;
    int made = 0;
    for (const int dimension : {2, 3})
      for (const auto& [site, cell] : random_sites(entry->place, {dimension}))
        for (int trial = 0; trial < (entry->place == ElementPlace::nodes ? 10 : 500); ++trial) {
          std::vector<Parameter> parameters = random_parameters(*entry, usual);
          std::unique_ptr<const Element> element;
          try {
            element = make_element(*entry, table_of(*entry, parameters, site), site, cell);
          } catch (const InputError&) {
            continue;
          }
          ++made;
          property(shown(*entry, parameters), *element, site);
          break;
        }
    if (made == 0) RC_FAIL("no random parameters suit " + std::string(entry->name));
  }
}

RC_GTEST_PROP(ElementProperties, MatricesAreSymmetricAndNotNegative, ()) {
  for_each_element([](const std::string& text, const Element& element, const ElementSite& site) {
    RC_ASSERT(std::ranges::equal(element.nodes(), site.nodes));
    RC_ASSERT(element.unknowns_per_node() <= site.space.unknowns());
    Matrix k, m, c;
    element.form({&k, &m, &c});
    for (const Matrix* each : {&k, &m, &c}) {
      RC_ASSERT(each->rows() == element.unknowns() && each->cols() == element.unknowns());
      RC_ASSERT(each->allFinite());
      if (!((*each - each->transpose()).norm() <= 1e-13 * each->norm())) RC_FAIL(text + ": a matrix is not symmetric");
      for (int trial = 0; trial < 5; ++trial) {
        Vector x(each->rows());
        for (double& value : x) value = between(-1, 1);
        if (!(x.dot(*each * x) >= -1e-12 * each->norm() * x.squaredNorm())) RC_FAIL(text + ": a matrix is not positive semidefinite");
      }
    }
  });
}

RC_GTEST_PROP(ElementProperties, OnlyElementsOnTheGroundResistATranslation, ()) {
  for_each_element(
      [](const std::string& text, const Element& element, const ElementSite& site) {
        if (site.nodes.size() < 2) return;
        Matrix k, c;
        element.form({&k, nullptr, &c});
        for (int direction = 0; direction < site.space.dimension; ++direction) {
          Vector u = Vector::Zero(element.unknowns());
          for (Index i = direction; i < u.size(); i += element.unknowns_per_node()) u[i] = 1;
          if (!((k * u).norm() <= 1e-12 * k.norm() && (c * u).norm() <= 1e-12 * c.norm())) RC_FAIL(text + ": a translation meets a force");
        }
      },
      ElementPlace::faces);  // what they stand on is the ground
}

RC_GTEST_PROP(ElementProperties, WithoutDisplacementNothingIsRemembered, ()) {
  for_each_element([](const std::string& text, const Element& element, const ElementSite&) {
    const auto size = static_cast<std::size_t>(element.num_history());
    const std::vector<double> natural(size, 0.0);
    if (size > 0 && element.has_yielded(natural)) RC_FAIL(text + ": the natural state has yielded");
    const Vector still = Vector::Zero(element.unknowns());
    for (std::size_t k = 0; k < element.outputs().size(); ++k)
      for (const double value : element.at_nodes(k, still, natural)) RC_ASSERT(value == 0);
  });
}

}  // namespace
}  // namespace uplift::elements_test
