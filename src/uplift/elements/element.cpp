#include "uplift/elements/element.h"

#include <cassert>

namespace uplift {

double Element::axial_force(const Vector&) const {
  return 0;
}

void Element::geometric(double, Matrix& stiffness) const {
  stiffness.setZero(unknowns(), unknowns());
}

Vec3 Element::first_moment() const {
  return Vec3::Zero();
}

SectionRows Element::section(double) const {
  assert(!"an element with an axis gives its section forces");
  return {};
}

Mat3 Element::axes() const {
  assert(!"an element with an axis gives its local axes");
  return Mat3::Identity();
}

Cell Element::cell() const {
  assert(!"a solid gives its cell");
  return Cell::point;
}

// Elements with memory override these; others are not asked.

BulkResponse Element::respond(const Vector&, std::span<const double>, std::span<double>, ElementScratch&, Vector*, Matrix*) const {
  assert(!"an element with memory responds");
  return {};
}

bool Element::has_yielded(std::span<const double>) const {
  return false;
}

bool Element::yields(std::span<const double>, std::span<const double>) const {
  return false;
}

void Element::find_inelastic(std::span<const double>, ElementScratch&, Inelastic& made) const {
  made.force.setZero(unknowns());
  made.energy = 0;
}

void Element::find_inelastic_of_response(std::span<const double> history, ElementScratch& scratch, Inelastic& made) const {
  find_inelastic(history, scratch, made);
}

double Element::dissipated(const Vector&, std::span<const double>, const Vector&, std::span<const double>) const {
  return 0;
}

std::vector<double> Element::at_nodes(std::size_t, const Vector&, std::span<const double>) const {
  assert(!"an element gives every output that it announces");
  return {};
}

}  // namespace uplift
