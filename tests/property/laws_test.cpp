#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "property/random_parts.h"
#include "unit/laws/laws_support.h"
#include "uplift/laws/tangential.h"

// Properties of every law in the catalog. Parameters are drawn from the law's own declaration, so that a new law is tested before its
// author writes a test.
namespace uplift::laws_test {
using namespace law_test;
using namespace random_parts;
namespace {

/// A usual size of a quantity, by its unit.
double usual(std::string_view unit_name) {
  if (unit_name == "Pa/m") return magnitude(1e8, 1e10);
  if (unit_name == "Pa") return magnitude(1e4, 1e6);
  if (unit_name == "J/m2") return magnitude(10, 1e3);
  if (unit_name == "Pa s/m") return magnitude(1e4, 1e7);
  if (unit_name == "m") return magnitude(1e-5, 1e-2);
  return unit();
}

struct Law {
  std::vector<Parameter> parameters;
  std::shared_ptr<const InterfaceLaw> law;
  std::string tangential;
};

/// A law with random parameters within their bounds.
Law random_law(const Entry<InterfaceLaw>& entry) {
  return random_part<Law>(entry, usual, [&](const std::vector<Parameter>& parameters) {
    const Values values = checked(std::string(entry.name), parameters);
    return Law{parameters, make_part(law_catalog(), values), tangential_kind(values)};
  });
}

std::string shown(const Entry<InterfaceLaw>& entry, const Law& law) {
  return random_parts::shown(entry, law.parameters);
}

/// Openings of one point; the normal one reaches from compression to wide open.
std::vector<double> random_opening(int components, double size) {
  std::vector<double> opening;
  for (int c = 0; c < components; ++c) opening.push_back(size * between(c == components - 1 ? -1 : -0.5, c == components - 1 ? 2 : 0.5));
  return opening;
}

/// An interface with a random past; `opening` is where it stands.
struct Situation {
  Probe probe;
  std::vector<double> opening;
  double size;
};

Situation random_situation(const Law& law, int components) {
  const double size = magnitude(1e-5, 3e-3), step = one_in(3) ? 0 : magnitude(1e-4, 1e-2);
  Situation s{Probe(law.law, components, 1, step), std::vector<double>(static_cast<std::size_t>(components), 0.0), size};
  for (int past = integer_in(0, 4); past > 0; --past) {
    const auto next = random_opening(components, size);
    s.probe.go(s.opening, next);
    s.opening = next;
  }
  return s;
}

double largest_stiffness(const InterfaceLaw& law) {
  double stiffness[3];
  law.closed_stiffness(3, stiffness);
  return std::max({stiffness[0], stiffness[1], stiffness[2]});
}

/// Runs a property for every law, with several sets of parameters.
void for_each_law(const std::function<void(const Entry<InterfaceLaw>&, const Law&)>& property, int sets = 1) {
  for (const Entry<InterfaceLaw>* entry : law_catalog()) {
    if (entry->name == "external") continue;  // the caller's: no parameters make it
    for (int i = 0; i < sets; ++i) {
      const Law law = random_law(*entry);
      property(*entry, law);
    }
  }
}

using Question = const std::vector<double>& (Probe::*)(const std::vector<double>&, const std::vector<double>&);

/// d traction[row]/d opening[column] by differences of fourth order, with its own check of smoothness: nothing where two steps disagree (a
/// kink is near).
std::optional<double> difference(Probe& probe, Question question, const std::vector<double>& from, std::vector<double> to, int row,
                                 int column, double h, double size) {
  const auto quotient = [&](double step) {
    const auto at = [&](double shift) {
      std::vector<double> moved = to;
      moved[static_cast<std::size_t>(column)] += shift;
      return (probe.*question)(from, moved)[static_cast<std::size_t>(row)];
    };
    return (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step);
  };
  const double coarse = quotient(h), fine = quotient(0.5 * h);
  if (std::abs(coarse - fine) > 1e-7 * (size + std::abs(fine))) return std::nullopt;
  return fine;
}

void slope_is_derivative(Question question) {
  int every = 0, checked_entries = 0;
  for_each_law(
      [&](const Entry<InterfaceLaw>& entry, const Law& law) {
        const int components = integer_in(1, 4);
        Situation s = random_situation(law, components);
        const auto to = random_opening(components, s.size);
        const double size = largest_stiffness(*law.law);
        int smooth = 0;
        for (int row = 0; row < components; ++row)
          for (int column = 0; column < components; ++column) {
            const auto expected = difference(s.probe, question, s.opening, to, row, column, 1e-4 * s.size, size);
            if (!expected) continue;
            ++smooth;
            (s.probe.*question)(s.opening, to);
            const double found = s.probe.slope_at(row, column);
            if (std::abs(found - *expected) > 1e-6 * (size + std::abs(*expected)))
              RC_FAIL(shown(entry, law) + ": slope " + std::to_string(row) + std::to_string(column) + " is " + std::to_string(found) +
                      ", differences give " + std::to_string(*expected));
          }
        every += components * components;
        checked_entries += smooth;
      },
      10);
  RC_ASSERT(checked_entries > 0.9 * every);
}

RC_GTEST_PROP(LawProperties, SlopeAtTheEndOfAStepIsTheDerivative, ()) {
  slope_is_derivative(&Probe::respond);
}
RC_GTEST_PROP(LawProperties, SlopeOfThePathAverageIsTheDerivative, ()) {
  slope_is_derivative(&Probe::mean);
}

RC_GTEST_PROP(LawProperties, PathAverageIsTheQuadratureOfTheResponse, ()) {
  for_each_law([](const Entry<InterfaceLaw>& entry, const Law& law) {
    Situation s = random_situation(law, 1);
    const double from = s.opening[0], to = random_opening(1, s.size)[0], step = s.probe.batch.step;
    RC_PRE(std::abs(to - from) > 1e-3 * s.size);
    double size = 0;
    const auto along = [&](double x) {  // at the same rate of opening
      s.probe.batch.step = step * (x - from) / (to - from);
      const double t = s.probe.respond({from}, {x})[0];
      size = std::max(size, std::abs(t));
      return t;
    };
    for (int i = 1; i <= 64; ++i) along(from + (to - from) * i / 64);
    // no finer than the rounding of the openings, or the recursion would chase noise
    const double rounding = 1e-14 * largest_stiffness(*law.law) * s.size,
                 tolerance = (1e-12 * size + 0.1 * rounding) * std::abs(to - from) / 64;
    double sum = 0;
    for (int i = 0; i < 64; ++i) sum += integral(along, from + (to - from) * i / 64, from + (to - from) * (i + 1) / 64, tolerance, 40);
    s.probe.batch.step = step;
    const double found = s.probe.mean({from}, {to})[0];
    if (!(std::abs(found - sum / (to - from)) <= 1e-10 * size + rounding))
      RC_FAIL(shown(entry, law) + ": average " + std::to_string(found) + ", quadrature " + std::to_string(sum / (to - from)));
  });
}

RC_GTEST_PROP(LawProperties, WorkIsTheChangeOfStoredPlusDissipatedEnergy, ()) {
  for_each_law([](const Entry<InterfaceLaw>& entry, const Law& law) {
    const int components = integer_in(1, 4);
    Situation s = random_situation(law, components);
    for (int step = 0; step < 5; ++step) {
      auto to = random_opening(components, s.size);
      if (one_in(3))  // a tiny step
        for (std::size_t c = 0; c < to.size(); ++c) to[c] = s.opening[c] + 1e-6 * (to[c] - s.opening[c]);
      const auto [stored, dissipated] = s.probe.energy(s.opening, s.probe.memory);
      const double work = s.probe.go(s.opening, to);
      const auto [stored_now, dissipated_now] = s.probe.energy(to, s.probe.memory);
      s.opening = to;
      const double miss = work - (stored_now - stored) - (dissipated_now - dissipated), size = stored + stored_now + dissipated_now;
      const double rounding = 1e-15 * largest_stiffness(*law.law) * s.size * s.size;  // of the openings themselves
      if (!(std::abs(miss) <= 1e-12 * size + rounding))
        RC_FAIL(shown(entry, law) + ": work " + std::to_string(work) + " misses " + std::to_string(miss / size));
      if (!(dissipated_now - dissipated >= -1e-14 * size - rounding)) RC_FAIL(shown(entry, law) + ": dissipated energy came back");
      RC_ASSERT(stored_now >= 0);
    }
  });
}

RC_GTEST_PROP(LawProperties, NoClosedLoopGivesEnergy, ()) {
  for_each_law([](const Entry<InterfaceLaw>& entry, const Law& law) {
    const int components = integer_in(1, 4);
    Situation s = random_situation(law, components);
    const auto start = s.opening;
    const double before = s.probe.stored(start, s.probe.memory);
    double work = 0, gross = before;
    // Two rounds of the same loop: what the first changes in the memory must not be won back in the second either.
    std::vector<std::vector<double>> corners;
    for (int i = 0; i < 6; ++i) corners.push_back(random_opening(components, s.size));
    corners.push_back(start);
    for (int round = 0; round < 2; ++round)
      for (const auto& to : corners) {
        const double part = s.probe.go(s.opening, to);
        work += part;
        gross += std::abs(part);
        s.opening = to;
      }
    // The energy that was stored at the start may come out once; no more.
    const double after = s.probe.stored(start, s.probe.memory);
    if (!(work - (after - before) >= -1e-12 * gross))
      RC_FAIL(shown(entry, law) + ": a closed loop gave " + std::to_string(after - before - work));
  });
}

RC_GTEST_PROP(LawProperties, UnitsScale, ()) {
  for_each_law([](const Entry<InterfaceLaw>& entry, const Law& law) {
    const double length = std::exp2(integer_in(-6, 7)), pressure = std::exp2(integer_in(-9, 10));
    std::vector<Parameter> scaled = law.parameters;
    for (auto& [key, value] : scaled) {
      double* number = std::get_if<double>(&value);
      if (number == nullptr) continue;
      const auto field = std::find_if(entry.params.begin(), entry.params.end(), [&key = key](const Field& f) { return f.name == key; });
      if (field->unit == "Pa")
        *number *= pressure;
      else if (field->unit == "Pa/m" || field->unit == "Pa s/m")
        *number *= pressure / length;
      else if (field->unit == "J/m2")
        *number *= pressure * length;
      else if (field->unit == "m")
        *number *= length;
      else
        RC_ASSERT(field->unit == std::string_view("1"));
    }
    const auto other_law = make_law(std::string(entry.name), scaled);
    const int components = integer_in(1, 4);
    const double size = magnitude(1e-5, 3e-3), step = magnitude(1e-4, 1e-2);
    Probe one(law.law, components, 1, step), other(other_law, components, 1, step);
    std::vector<double> from(static_cast<std::size_t>(components), 0.0), other_from = from;
    const double stiffness = largest_stiffness(*law.law);
    for (int i = 0; i < 4; ++i) {
      const auto to = random_opening(components, size);
      auto other_to = to;
      for (double& x : other_to) x *= length;
      one.go(from, to);
      other.go(other_from, other_to);
      for (std::size_t r = 0; r < to.size(); ++r) {
        RC_ASSERT(std::abs(one.traction[r] * pressure - other.traction[r]) <= 1e-12 * pressure * stiffness * size);
        RC_ASSERT(std::abs(one.end[r] * pressure - other.end[r]) <= 1e-12 * pressure * stiffness * size);
      }
      const auto [stored, dissipated] = one.energy(to, one.memory);
      const auto [other_stored, other_dissipated] = other.energy(other_to, other.memory);
      RC_ASSERT(std::abs(stored * pressure * length - other_stored) <= 1e-12 * other_stored);
      RC_ASSERT(std::abs(dissipated * pressure * length - other_dissipated) <= 1e-11 * (other_stored + other_dissipated));
      from = to;
      other_from = other_to;
    }
  });
}

RC_GTEST_PROP(LawProperties, ComponentsAgree, ()) {
  for_each_law([](const Entry<InterfaceLaw>& entry, const Law& law) {
    const double size = magnitude(1e-5, 3e-3), step = magnitude(1e-4, 1e-2), angle = between(0, 6.3), c = std::cos(angle),
                 s = std::sin(angle);
    Probe normal(law.law, 1, 1, step), plane(law.law, 2, 1, step), space(law.law, 3, 1, step);
    const double tolerance = 1e-11 * largest_stiffness(*law.law) * size;
    std::vector<double> from{0, 0};
    for (int i = 0; i < 4; ++i) {
      const auto to = random_opening(2, size);
      for (const Question question : {Question{&Probe::respond}, Question{&Probe::mean}}) {
        (normal.*question)({from[1]}, {to[1]});
        (plane.*question)(from, to);
        (space.*question)({c * from[0], s * from[0], from[1]}, {c * to[0], s * to[0], to[1]});
        RC_ASSERT(std::abs(normal.traction[0] - plane.traction[1]) <= tolerance);
        RC_ASSERT(std::abs(normal.traction[0] - space.traction[2]) <= tolerance);
        RC_ASSERT(std::abs(normal.slope_at(0, 0) - plane.slope_at(1, 1)) <= tolerance / size);
        if (std::abs(c * plane.traction[0] - space.traction[0]) > tolerance ||
            std::abs(s * plane.traction[0] - space.traction[1]) > tolerance)
          RC_FAIL(shown(entry, law) + ": the plane's answer depends on the axes");
      }
      normal.accept(), plane.accept(), space.accept();
      from = to;
    }
  });
}

RC_GTEST_PROP(LawProperties, ABatchIsItsPoints, ()) {
  for_each_law([](const Entry<InterfaceLaw>& entry, const Law& law) {
    const int components = integer_in(1, 4), points = integer_in(1, 140);
    const double size = magnitude(1e-5, 3e-3), step = magnitude(1e-4, 1e-2), stiffness = largest_stiffness(*law.law);
    const auto n = static_cast<std::size_t>(points), rows = n * static_cast<std::size_t>(components);
    Probe batch(law.law, components, points, step);
    std::vector<Probe> single(n, Probe(law.law, components, 1, step));
    std::vector<double> from(rows, 0.0), to(rows);
    const auto point_of = [&](const std::vector<double>& all, std::size_t i) {
      std::vector<double> one;
      for (std::size_t c = 0; c < rows / n; ++c) one.push_back(all[c * n + i]);
      return one;
    };
    const double shift = unit(), turn = between(0.1, 3);
    for (int move = 0; move < 3; ++move) {
      for (std::size_t i = 0; i < rows; ++i) to[i] = size * (0.5 + 1.5 * std::sin(shift * 6 + turn * static_cast<double>(i) + 2.1 * move));
      for (const Question question : {Question{&Probe::respond}, Question{&Probe::mean}}) {
        (batch.*question)(from, to);
        for (std::size_t i = 0; i < n; ++i) {
          (single[i].*question)(point_of(from, i), point_of(to, i));
          for (std::size_t r = 0; r < rows / n; ++r) {
            RC_ASSERT(std::abs(batch.traction[r * n + i] - single[i].traction[r]) <= 1e-12 * stiffness * size);
            for (std::size_t c = 0; c < rows / n; ++c) {
              const double a = batch.slope_at(static_cast<int>(r), static_cast<int>(c), static_cast<int>(i)),
                           b = single[i].slope_at(static_cast<int>(r), static_cast<int>(c));
              if (std::abs(a - b) > 1e-9 * (stiffness + std::abs(b))) RC_FAIL(shown(entry, law) + ": slope of point " + std::to_string(i));
            }
          }
          for (std::size_t h = 0; h < single[i].now.size(); ++h)
            RC_ASSERT(std::abs(batch.now[h * n + i] - single[i].now[h]) <= 1e-12 * std::max(size, std::abs(single[i].now[h])));
        }
      }
      batch.accept();
      for (Probe& one : single) one.accept();
      from = to;
    }
  });
}

RC_GTEST_PROP(LawProperties, WhatIsNotWantedChangesNothing, ()) {
  for_each_law([](const Entry<InterfaceLaw>&, const Law& law) {
    const int components = integer_in(1, 4);
    Situation s = random_situation(law, components);
    const auto to = random_opening(components, s.size);
    const InterfaceLaw& behaviour = s.probe.law();
    std::vector<double> bare(to.size()), end(to.size()), now(s.probe.now.size());
    s.probe.mean(s.opening, to);
    behaviour.mean(s.probe.batch, s.opening.data(), to.data(), s.probe.memory.data(), {.traction = bare.data()});
    RC_ASSERT(bare == s.probe.traction);
    behaviour.mean(s.probe.batch, s.opening.data(), to.data(), s.probe.memory.data(),
                   {.traction = bare.data(), .now = now.data(), .end = end.data()});
    RC_ASSERT(bare == s.probe.traction);
    RC_ASSERT(now == s.probe.now);
    RC_ASSERT(end == s.probe.end);
    s.probe.respond(s.opening, to);
    behaviour.respond(s.probe.batch, s.opening.data(), to.data(), s.probe.memory.data(), {.traction = bare.data()});
    RC_ASSERT(bare == s.probe.traction);
    double stored = 0, dissipated = 0;
    behaviour.energy(s.probe.batch, to.data(), s.probe.now.data(), &stored, nullptr);
    behaviour.energy(s.probe.batch, to.data(), s.probe.now.data(), nullptr, &dissipated);
    RC_ASSERT(stored == s.probe.stored(to, s.probe.now));
    RC_ASSERT(dissipated == s.probe.dissipated(to, s.probe.now));
  });
}

RC_GTEST_PROP(LawProperties, AStepThatDoesNotMoveGivesTheTractionThere, ()) {
  for_each_law([](const Entry<InterfaceLaw>& entry, const Law& law) {
    const int components = integer_in(1, 4);
    Situation s = random_situation(law, components);
    const double tolerance = 1e-12 * largest_stiffness(*law.law) * s.size;
    const auto there = s.probe.respond(s.opening, s.opening);
    s.probe.mean(s.opening, s.opening);
    for (std::size_t r = 0; r < there.size(); ++r) {
      if (std::abs(s.probe.traction[r] - there[r]) > tolerance || std::abs(s.probe.end[r] - there[r]) > tolerance)
        RC_FAIL(shown(entry, law) + ": average " + std::to_string(s.probe.traction[r]) + ", end " + std::to_string(s.probe.end[r]) +
                ", response " + std::to_string(there[r]));
    }
  });
}

RC_GTEST_PROP(LawProperties, ClosedStiffnessIsThatOfDeepCompression, ()) {
  for_each_law([](const Entry<InterfaceLaw>&, const Law& law) {
    double stiffness[3];
    law.law->closed_stiffness(3, stiffness);
    Probe probe(law.law, 3);
    probe.respond({0, 0, 0}, {1e-9, 1e-9, -1});
    RC_ASSERT(std::abs(probe.slope_at(2, 2) - stiffness[2]) <= 1e-12 * stiffness[2]);
    if (law.tangential == "coulomb") return;  // sticks or slips, depending on its friction
    for (int c = 0; c < 2; ++c) RC_ASSERT(std::abs(probe.slope_at(c, c) - stiffness[c]) <= 1e-12 * stiffness[c]);
    RC_ASSERT((law.tangential == "none") == (stiffness[0] == 0));
  });
}

RC_GTEST_PROP(LawProperties, AnOpeningThatIsNoNumberGivesNoNumber, ()) {
  for_each_law([](const Entry<InterfaceLaw>&, const Law& law) {
    const int points = integer_in(1, 20), bad = integer_in(0, points);
    Probe probe(law.law, 1, points);
    std::vector<double> from(static_cast<std::size_t>(points), 0.0), to = random_opening(points, 1e-3);
    to[static_cast<std::size_t>(bad)] = std::numeric_limits<double>::quiet_NaN();
    for (const Question question : {Question{&Probe::respond}, Question{&Probe::mean}}) {
      (probe.*question)(from, to);
      for (int i = 0; i < points; ++i) RC_ASSERT(std::isnan(probe.traction[static_cast<std::size_t>(i)]) == (i == bad));
    }
  });
}

}  // namespace
}  // namespace uplift::laws_test
