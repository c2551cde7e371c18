#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "uplift/contact/impact/impact.h"
#include "uplift/contact/method.h"
#include "uplift/math/dense.h"

// What the tests of the contact layer share: parts by name, and small interface problems built by hand.
namespace uplift::contact_test {

using Numbers = std::vector<std::pair<std::string, double>>;

inline Values values_of(const std::string& type, const Numbers& numbers, std::span<const PartInfo* const> catalog) {
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", Raw{type, {}, "type"});
  for (const auto& [key, value] : numbers) table->entries.emplace_back(key, Raw{value, {}, key});
  return check_part(Raw{table, {}, "test"}, catalog);
}
inline std::unique_ptr<const ContactMethod> method(const std::string& name, const Numbers& numbers = {}) {
  return make_part(method_catalog(), values_of(name, numbers, contact_methods()));
}
inline std::unique_ptr<const ImpactRule> rule(const std::string& name, const Numbers& numbers = {}) {
  return make_part(impact_catalog(), values_of(name, numbers, impact_rules()));
}
inline std::unique_ptr<const Cone> cone(double friction) {
  return friction > 0 ? make_part(cone_catalog(), values_of("coulomb", {{"friction", friction}}, interface_behaviours()))
                      : make_part(cone_catalog(), values_of("unilateral", {}, interface_behaviours()));
}
inline std::unique_ptr<const InterfaceLaw> springs(double stiffness) {
  return make_part(law_catalog(), values_of("springs", {{"K_n", stiffness}}, interface_behaviours()));
}

/// A problem that owns its behaviours.
struct Own {
  std::shared_ptr<ContactModel> model = std::make_shared<ContactModel>();
  InterfaceProblem problem = problem_of(model);
  std::vector<std::unique_ptr<const Cone>> cones;
  std::vector<std::unique_ptr<const InterfaceLaw>> laws;

  /// A new model in place of the present one, to be changed before a method sees it.
  ContactModel& change() {
    problem.model = model = std::make_shared<ContactModel>(*model);
    return *model;
  }
  Block& add(const std::string& name, int points, int components, const std::vector<double>& area) {
    Block block;
    block.name = name;
    for (const Block& other : model->blocks) block.first = other.first + other.rows();
    block.first_history = static_cast<int>(problem.old.size());
    block.batch = Batch{points, components, 0};
    block.area = ConstMap(area.data(), static_cast<Index>(area.size()));
    return change().blocks.emplace_back(std::move(block));
  }
  void add_cone(const std::string& name, int points, int components, double friction, std::vector<double> area = {}) {
    if (area.empty()) area.assign(static_cast<std::size_t>(points), 1.0);
    cones.push_back(cone(friction));
    add(name, points, components, area).cone = cones.back().get();
  }
  void add_springs(const std::string& name, int points, double stiffness) {
    laws.push_back(springs(stiffness));
    Block& block = add(name, points, 1, std::vector<double>(static_cast<std::size_t>(points), 1.0));
    block.law = laws.back().get();
    problem.old.conservativeResizeLike(Vector::Zero(problem.old.size() + block.law->num_history(1) * points));
  }
  void set(Matrix factor, Vector free_opening) {
    change().factor = std::move(factor);
    problem.free_opening = std::move(free_opening);
    problem.from = Vector::Zero(problem.rows());
  }
};

/// A rigid footing on `points` nodal points of total width 2 b: rows of B for (u_y, theta), areas by the trapezoidal rule.
struct Footing {
  Matrix b;
  std::vector<double> x, area;
};
inline Footing footing(int points, double half_width) {
  Footing result{Matrix(points, 2), {}, {}};
  for (int i = 0; i < points; ++i) {
    const double x = -half_width + 2 * half_width * i / (points - 1);
    result.b(i, 0) = 1;
    result.b(i, 1) = x;
    result.x.push_back(x);
    result.area.push_back(2 * half_width / (points - 1) * (i == 0 || i == points - 1 ? 0.5 : 1.0));
  }
  return result;
}

/// Factor of B K^-1 B^T, and the spread K^-1 B^T = spread factor^T.
inline Spread spread_of(const Matrix& stiffness, const Matrix& b) {
  const Matrix back = inverse(Matrix(Cholesky(stiffness)->matrixL()));  // L^-1
  return {b * back.transpose(), back.transpose()};
}

}  // namespace uplift::contact_test
