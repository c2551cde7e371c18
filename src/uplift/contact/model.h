#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "uplift/contact/jumps.h"
#include "uplift/interface/interface.h"
#include "uplift/math/linalg.h"

// The constant part of the interface problems of a step size. With the linear subsystem condensed, the step is
//     opening = free_opening + C z        z + C^T (p - D opening) = 0        p in law(opening)
// where F = C C^T = B K_eff^-1 B^T is the compliance [m/N] and z [sqrt(J)] are coordinates in which the energy of K_eff is |z|^2/2.
// C has as many columns as the smaller of the two exact forms needs (docs/theory, eq (13)): the interface rows m, or the independent
// unknowns that the interface touches (three for a rigid footing in 2D). F itself is never inverted; it is singular under a rigid footing.
// D [N/m] is zero in dynamics; in statics it takes back the closed joint that was put into the factored matrix (docs/theory, section 4).
namespace uplift {

/// One interface inside the problem.
struct Block {
  std::string name;
  int first = 0;          // first row
  int first_history = 0;  // first memory value
  Batch batch;
  const InterfaceLaw* law = nullptr;  // one of the two
  const Cone* cone = nullptr;
  Vector area;                         // m2 per point: Interface::weight
  std::optional<Footprint> footprint;  // of a whole foundation
  // of a stored problem: the law that a method had put in the cone's place (penalty)
  double substitute_stiffness = 0;        // Pa/m
  std::vector<double> substitute_memory;  // at the beginning of the step
  int rows() const { return batch.points * batch.components; }
  int normal_row() const { return first + batch.normal(); }  // of the first point
  int slopes() const { return rows() * batch.components; }
};

/// How the linear problems of interfaces with many independent rows are solved, see PointRows.
enum class InterfaceSolver : signed char { automatic, direct, krylov };

/// Tells contact models apart: every new model has a version of its own, copies included, and a version never comes back while somebody
/// remembers it.
class ModelVersion {
 public:
  ModelVersion() : token_(std::make_shared<char>()) {}
  ModelVersion(const ModelVersion&) : ModelVersion() {}
  ModelVersion(ModelVersion&&) = default;
  ModelVersion& operator=(const ModelVersion& other) {
    if (this != &other) token_ = std::make_shared<char>();
    return *this;
  }
  ModelVersion& operator=(ModelVersion&&) = default;
  ~ModelVersion() = default;

 private:
  friend class SeenModel;
  std::shared_ptr<const char> token_;
};

/// Opening of a closed point as far as contact is solved, relative to the size of the interfaces.
inline constexpr double no_gap = 1e-12;

/// Shared by all steps of one size and constant once a method has seen it: another factor is another model.
struct ContactModel {
  std::vector<Block> blocks;
  Matrix factor;         // C: rows x r [m/sqrt(J)]
  JumpFactor jumps;      // C = W L, for those who can use it
  Vector shift;          // D: rows [N/m]; in dynamics empty, unless interfaces alone hold a massless unknown
  bool average = false;  // path-averaged traction: p = scale * area * mean(from -> opening)
  InterfaceSolver solver = InterfaceSolver::automatic;
  bool forces_suffice = false;  // whoever takes the step reads the forces of a solution, not its z
  double scale = 1;             // weight of the interface force in the scheme's balance: with the path average 2/(1 + 2 b), else 1
  double step = 0;              // s; 0 in statics
  double size = 1;              // m: of the interfaces, base_size(); what is no gap is a share of it
  ModelVersion version;
  int rows() const { return static_cast<int>(factor.rows()); }
};

/// Largest area * F_ii [m3/N] over the normal rows of a block: the displacement of a point under a unit pressure on its own area.
double flexibility(const ContactModel&, const Block&);

/// H += C_left^T diag(weight) C_right for as many rows as there are weights, from rows `left` and `right` on.
void add_weighted_gram(const ContactModel&, Index left, Index right, const ConstMap& weight, Matrix& work, Matrix& hessian);

/// The model that work space was made for.
class SeenModel {
 public:
  bool is(const ContactModel& model) const { return token_ != nullptr && token_ == model.version.token_; }
  void take(const ContactModel& model) { token_ = model.version.token_; }

 private:
  std::shared_ptr<const char> token_;
};

}  // namespace uplift
