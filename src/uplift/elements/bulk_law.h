#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "uplift/base/catalog.h"
#include "uplift/elements/material.h"

// Bulk laws: the stress of a continuum from its strain, with memory, in plane strain and in three dimensions. Small strains; tension > 0.
//   stress = D (strain - e),   D: stiffness of the elastic material, e: inelastic strain   (docs/theory, section 9)
// Every law is written in this form: the linear solid is in the matrices of the model, and e alone is what the law adds to it.
namespace uplift {

/// The integration points of one element in one update. The memory of point p begins at num_history() * p: its inelastic strain (6 numbers
/// in the order of Strain), then what else the law remembers. All memory is zero in the natural state.
struct BulkPoints {
  std::span<const Strain> strain;  // at the end of the step
  const double* old;               // memory at its beginning
  double* now;                     // filled: memory at its end
  Stress* stress;                  // filled: at its end [Pa]
  Mat6* tangent;                   // filled: d stress/d strain of this update [Pa]; null: not wanted
  double duration = 0;             // of the step [s]; 0 in a static stage
};

/// Stresses that the points of one element would have if their memory stayed: a component of all points after another.
struct BulkTrial {
  const double* stress;  // Pa: component c of point p at [c * stride + p]; zero from `points` on
  int stride, points;    // stride: whole vector registers (math/lanes.h)
  const double* old;     // memory, as in BulkPoints
};

/// How an update ended; not converged: the step is to be cut.
struct BulkResponse {
  bool converged = true;
  std::string why;
};

/// A quantity that field files show besides the stress.
struct BulkOutput {
  std::string_view name, unit;
};

/// A law is const; memory is passed in and out.
class BulkLaw {
 public:
  explicit BulkLaw(const ElasticMaterial& material) : material_(material), elastic_(elastic_matrix(material)) {}
  virtual ~BulkLaw() = default;
  const ElasticMaterial& material() const { return material_; }
  const Mat6& elastic() const { return elastic_; }  // D [Pa]

  /// True where e is always zero: the solid then needs no iteration and no memory, and nothing below is called.
  virtual bool linear() const { return false; }
  /// Numbers that a point remembers: at least the 6 of e.
  virtual int num_history() const = 0;
  /// Updates all points; implicit (end of step). A step in which e does not change must leave e as it was, bit by bit.
  virtual BulkResponse respond(const BulkPoints& points) const = 0;
  /// A short way for elements in which nothing happens: true where `respond` would leave the memory of all points as it is. False is always
  /// right; `respond` then decides.
  virtual bool stays_elastic(const BulkTrial& trial) const;
  /// Energy [J/m3] that a point stores besides the recoverable energy (strain - e).D (strain - e)/2. It depends on the memory alone, and
  /// changes only where e does.
  virtual double locked_energy(const double* history) const;
  /// What the memory says in field files: names and units, and one value for each of them.
  virtual std::span<const BulkOutput> outputs() const { return {}; }
  virtual void find_outputs(const double* history, double* values) const;

 private:
  ElasticMaterial material_;
  Mat6 elastic_;
};

/// The solid that a law is made for.
struct BulkLawContext {
  ElasticMaterial material;  // its elastic part
  int dimension = 3;         // of the mesh; 2: plane strain
};
/// Made from that and the parameters of the law.
using BulkLawEntry = Entry<BulkLaw, BulkLawContext>;
std::span<const BulkLawEntry* const> bulk_law_catalog();
/// The shared library that a law is in, as a path from here; empty: none.
std::filesystem::path library_of(const Values& law);
std::span<const PartInfo* const> bulk_laws();

}  // namespace uplift
