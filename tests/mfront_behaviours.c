/* Behaviours for tests, with the symbols and the data of a library that MFront makes with its generic interface (version 1): written by hand,
 * because MFront is not in Debian. Tensors: xx, yy, zz, xy, xz, yz (plane strain: the first four), shear components times sqrt(2). */
#include <math.h>
#include <stddef.h>
#include <string.h>

typedef struct {
  const double* gradients;
  double* thermodynamic_forces;
  const double *mass_density, *material_properties;
  double *internal_state_variables, *stored_energy, *dissipated_energy;
  const double* external_state_variables;
} State;

typedef struct {
  char* error_message;
  double dt, *K, *rdt, *speed_of_sound;
  State s0, s1;
} Data;

/* ---- tensors of n numbers ---- */

static double unit(int i) { return i < 3 ? 1 : 0; }
static double trace(const double* t) { return t[0] + t[1] + t[2]; }
static double dot(int n, const double* a, const double* b) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

typedef struct {
  double shear, bulk; /* Pa */
} Elastic;
static Elastic elastic_of(const Data* d) {
  const double young = d->s1.material_properties[0], poisson = d->s1.material_properties[1];
  const Elastic e = {young / (2 * (1 + poisson)), young / (3 * (1 - 2 * poisson))};
  return e;
}
static void stress_of(Elastic e, int n, const double* strain, double* stress) {
  const double volume = trace(strain);
  for (int i = 0; i < n; ++i) stress[i] = 2 * e.shear * (strain[i] - unit(i) * volume / 3) + unit(i) * e.bulk * volume;
}
static void strain_of(Elastic e, int n, const double* stress, double* strain) {
  const double p = trace(stress) / 3;
  for (int i = 0; i < n; ++i) strain[i] = (stress[i] - unit(i) * p) / (2 * e.shear) + unit(i) * p / (3 * e.bulk);
}
static void isotropic_tangent(Data* d, int n, double shear, double bulk) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) d->K[n * i + j] = 2 * shear * ((i == j) - unit(i) * unit(j) / 3) + bulk * unit(i) * unit(j);
}
/* Stress of the step if it were elastic: from that at its beginning. */
static void trial_stress(const Data* d, Elastic e, int n, double* stress) {
  double increment[6] = {0};
  for (int i = 0; i < n; ++i) increment[i] = d->s1.gradients[i] - d->s0.gradients[i];
  stress_of(e, n, increment, stress);
  for (int i = 0; i < n; ++i) stress[i] += d->s0.thermodynamic_forces[i];
}
static int failed(Data* d, const char* why) {
  strcpy(d->error_message, why);
  return -1;
}

/* ---- linear elasticity; a limit on the strain; a limit on the step ---- */

static int linear(Data* d, int n) {
  const Elastic e = elastic_of(d);
  const int tangent = d->K[0] > 3.5;
  if (d->s0.mass_density == NULL || d->s1.external_state_variables[0] != 293.15) return failed(d, "no density or no temperature");
  trial_stress(d, e, n, d->s1.thermodynamic_forces);
  if (tangent) isotropic_tangent(d, n, e.shear, e.bulk);
  return 1;
}
static int brittle(Data* d, int n) {
  const double limit = d->s1.material_properties[2];
  if (limit <= 0) return failed(d, "StrainLimit is out of its bounds");
  if (dot(n, d->s1.gradients, d->s1.gradients) > limit * limit) return failed(d, "the strain is beyond StrainLimit");
  return linear(d, n);
}
static int impatient(Data* d, int n) {
  *d->rdt = d->dt > 1.5e-3 ? 0.5 : 1;
  const int done = linear(d, n);
  return done == 1 && *d->rdt < 0.99 ? 0 : done;
}
static int silent(Data* d, int n) { return d->s1.gradients[0] != 0 ? -1 : linear(d, n); }

/* ---- Maxwell's fluid in shear: s' = 2 G e' - (G/viscosity) s, implicit ---- */

static int maxwell(Data* d, int n) {
  const Elastic e = elastic_of(d);
  const double keep = 1 / (1 + e.shear * d->dt / d->s1.material_properties[2]);
  double* stress = d->s1.thermodynamic_forces;
  const int tangent = d->K[0] > 3.5;
  trial_stress(d, e, n, stress);
  const double p = trace(stress) / 3;
  for (int i = 0; i < n; ++i) stress[i] = keep * (stress[i] - unit(i) * p) + unit(i) * p;
  if (tangent) isotropic_tangent(d, n, keep * e.shear, e.bulk);
  return 1;
}

/* ---- von Mises with Prager's kinematic hardening: |s - X| <= sqrt(2/3) strength, X = 2/3 H plastic strain ---- */

static int prager(Data* d, int n) {
  const Elastic e = elastic_of(d);
  const double strength = sqrt(2.0 / 3) * d->s1.material_properties[2], hardening = 2.0 / 3 * d->s1.material_properties[3];
  const double* old = d->s0.internal_state_variables;
  double *plastic = d->s1.internal_state_variables, *stress = d->s1.thermodynamic_forces, recovered[6], moved[6];
  const int tangent = d->K[0] > 3.5;
  for (int i = 0; i < n; ++i) recovered[i] = d->s1.gradients[i] - old[i];
  stress_of(e, n, recovered, stress);
  const double p = trace(stress) / 3;
  for (int i = 0; i < n; ++i) moved[i] = stress[i] - unit(i) * p - hardening * old[i];
  const double size = sqrt(dot(n, moved, moved)), beyond = size > strength ? size - strength : 0;
  const double flow = beyond / (2 * e.shear + hardening), share = size > 0 ? 2 * e.shear * flow / size : 0;
  if (tangent) isotropic_tangent(d, n, (1 - share) * e.shear, e.bulk);
  for (int i = 0; i < n; ++i) {
    const double normal = beyond > 0 ? moved[i] / size : 0;
    plastic[i] = old[i] + flow * normal;
    stress[i] -= 2 * e.shear * flow * normal;
    for (int j = 0; j < n && tangent && beyond > 0; ++j)
      d->K[n * i + j] -= 2 * e.shear * (2 * e.shear / (2 * e.shear + hardening) - share) * normal * moved[j] / size;
  }
  strain_of(e, n, stress, recovered);
  *d->s1.stored_energy = dot(n, stress, recovered) / 2 + hardening * dot(n, plastic, plastic) / 2;
  return 1;
}

/* ---- Drucker-Prager through the compression edges of Mohr-Coulomb; variables: accumulated plastic strain, plastic strain ---- */

typedef struct {
  double eta, eta_bar, xi, cohesion, hardening;
} Cone;
static double slope_of(double angle) { return 6 * sin(angle) / (sqrt(3) * (3 - sin(angle))); }

/* Mean stress after the return to the apex; adds to the accumulated strain. */
static double to_apex(Data* d, Elastic e, Cone c, int n, double p, double* accumulated) {
  const double past = p - c.xi / c.eta * (c.cohesion + c.hardening * *accumulated);
  const double volumetric = e.bulk * c.eta * c.eta_bar, hardening = c.xi * c.xi * c.hardening;
  const int perfect = volumetric + hardening == 0;
  const double share = perfect ? 0 : hardening / (volumetric + hardening);
  *accumulated += perfect ? c.xi / c.eta * past / e.bulk : c.eta * c.xi * past / (volumetric + hardening);
  if (d->K[0] > 3.5) isotropic_tangent(d, n, 0, e.bulk * share);
  return p - (1 - share) * past;
}

static void cone_tangent(Data* d, Elastic e, Cone c, int n, const double* deviator, double root, double keep) {
  const double a = 1 / (e.shear + e.bulk * c.eta * c.eta_bar + c.xi * c.xi * c.hardening);
  isotropic_tangent(d, n, keep * e.shear, e.bulk * (1 - e.bulk * c.eta * c.eta_bar * a));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double ni = deviator[i] / (sqrt(2) * root), nj = deviator[j] / (sqrt(2) * root);
      d->K[n * i + j] += 2 * e.shear * (1 - keep - e.shear * a) * ni * nj -
                         sqrt(2) * e.shear * a * e.bulk * (c.eta * ni * unit(j) + c.eta_bar * unit(i) * nj);
    }
}

static int drucker_prager(Data* d, int n) {
  const Elastic e = elastic_of(d);
  const double *properties = d->s1.material_properties, *old = d->s0.internal_state_variables;
  const Cone c = {slope_of(properties[3]), slope_of(properties[4]), 6 * cos(properties[3]) / (sqrt(3) * (3 - sin(properties[3]))),
                  properties[2], properties[5]};
  double *stress = d->s1.thermodynamic_forces, *variables = d->s1.internal_state_variables, deviator[6], recovered[6];
  if (!(properties[4] <= properties[3])) return failed(d, "DilatancyAngle is larger than FrictionAngle");
  const int tangent = d->K[0] > 3.5;
  trial_stress(d, e, n, stress);
  double p = trace(stress) / 3, keep = 1, accumulated = old[0];
  for (int i = 0; i < n; ++i) deviator[i] = stress[i] - unit(i) * p;
  const double root = sqrt(dot(n, deviator, deviator) / 2), beyond = root + c.eta * p - c.xi * (c.cohesion + c.hardening * old[0]);
  const double flow = beyond / (e.shear + e.bulk * c.eta * c.eta_bar + c.xi * c.xi * c.hardening);
  if (beyond > 0 && c.eta > 0 && root < e.shear * flow) {
    keep = 0;
    p = to_apex(d, e, c, n, p, &accumulated);
  } else if (beyond > 0) {
    keep = 1 - e.shear * flow / root;
    if (tangent) cone_tangent(d, e, c, n, deviator, root, keep);
    p -= e.bulk * c.eta_bar * flow;
    accumulated += c.xi * flow;
  } else if (tangent) {
    isotropic_tangent(d, n, e.shear, e.bulk);
  }
  variables[0] = accumulated;
  for (int i = 0; i < n; ++i) stress[i] = keep * deviator[i] + unit(i) * p;
  strain_of(e, n, stress, recovered);
  for (int i = 0; i < n; ++i) variables[1 + i] = d->s1.gradients[i] - recovered[i];
  return 1;
}

/* ---- the symbols of each behaviour ---- */

#define LIST(name, list, count, ...)               \
  const unsigned short name##_n##list = count;     \
  const char* const name##_##list[] = {__VA_ARGS__};
#define NO_LIST(name, list)                    \
  const unsigned short name##_n##list = 0;     \
  const char* const* const name##_##list = NULL;
#define KIND(name, interface, version, type, symmetry)      \
  const unsigned short name##_mfront_mkt = 1;               \
  const char* const name##_mfront_interface = interface;    \
  const unsigned short name##_api_version = version;        \
  const unsigned short name##_BehaviourType = type;         \
  const unsigned short name##_BehaviourKinematic = type;    \
  const unsigned short name##_SymmetryType = symmetry;
#define USUAL(name) KIND(name, "Generic", 1, 1, 0)
#define BOTH(name, function)                                            \
  LIST(name, ModellingHypotheses, 2, "PlaneStrain", "Tridimensional")   \
  int name##_PlaneStrain(Data* d) { return function(d, 4); }            \
  int name##_Tridimensional(Data* d) { return function(d, 6); }
#define SPACE(name, function)                            \
  LIST(name, ModellingHypotheses, 1, "Tridimensional")   \
  int name##_Tridimensional(Data* d) { return function(d, 6); }
#define PROPERTIES(name, count, ...) LIST(name, MaterialProperties, count, __VA_ARGS__)
#define NO_VARIABLES(name)               \
  NO_LIST(name, InternalStateVariables)  \
  NO_LIST(name, ExternalStateVariables)
#define VARIABLES(name, count, types, ...)                       \
  LIST(name, InternalStateVariables, count, __VA_ARGS__)         \
  const int name##_InternalStateVariablesTypes[] = types;        \
  NO_LIST(name, ExternalStateVariables)
#define TYPES(...) {__VA_ARGS__}
#define ELASTIC "YoungModulus", "PoissonRatio"

USUAL(Linear) BOTH(Linear, linear) PROPERTIES(Linear, 2, ELASTIC) NO_VARIABLES(Linear)
USUAL(Brittle) BOTH(Brittle, brittle) PROPERTIES(Brittle, 3, ELASTIC, "StrainLimit") NO_VARIABLES(Brittle)
USUAL(Impatient) BOTH(Impatient, impatient) PROPERTIES(Impatient, 2, ELASTIC) NO_VARIABLES(Impatient)
USUAL(Silent) SPACE(Silent, silent) PROPERTIES(Silent, 2, ELASTIC) NO_VARIABLES(Silent)
USUAL(Maxwell) BOTH(Maxwell, maxwell) PROPERTIES(Maxwell, 3, ELASTIC, "Viscosity") NO_VARIABLES(Maxwell)

/* Young's modulus and Poisson's ratio as MFront lists them after @RequireStiffnessTensor; symbols of their own for one hypothesis. */
USUAL(Prager) SPACE(Prager, prager)
const unsigned short Prager_requiresStiffnessTensor = 1, Prager_ComputesInternalEnergy = 0, Prager_Tridimensional_ComputesInternalEnergy = 1;
LIST(Prager_Tridimensional, MaterialProperties, 2, "YieldStrength", "HardeningSlope")
NO_LIST(Prager, MaterialProperties)
VARIABLES(Prager, 1, TYPES(1), "PlasticStrain")

USUAL(DruckerPrager) BOTH(DruckerPrager, drucker_prager)
PROPERTIES(DruckerPrager, 6, ELASTIC, "Cohesion", "FrictionAngle", "DilatancyAngle", "HardeningSlope")
VARIABLES(DruckerPrager, 2, TYPES(0, 1), "EquivalentPlasticStrain", "PlasticStrain")

/* ---- what the program refuses ---- */

#define REST(name) BOTH(name, linear) PROPERTIES(name, 2, ELASTIC) NO_VARIABLES(name)
KIND(OtherInterface, "Castem", 1, 1, 0) REST(OtherInterface)
KIND(OldInterface, "Generic", 0, 1, 0) REST(OldInterface)
KIND(FiniteStrain, "Generic", 1, 2, 0) REST(FiniteStrain)
KIND(Orthotropic, "Generic", 1, 1, 1) REST(Orthotropic)
USUAL(PlaneOnly) PROPERTIES(PlaneOnly, 2, ELASTIC) NO_VARIABLES(PlaneOnly)
LIST(PlaneOnly, ModellingHypotheses, 2, "PlaneStrain", "Axisymmetrical")
int PlaneOnly_PlaneStrain(Data* d) { return linear(d, 4); }
USUAL(Humid) BOTH(Humid, linear) PROPERTIES(Humid, 2, ELASTIC) NO_LIST(Humid, InternalStateVariables)
LIST(Humid, ExternalStateVariables, 2, "Temperature", "Humidity")
USUAL(Incomplete) PROPERTIES(Incomplete, 2, ELASTIC) NO_VARIABLES(Incomplete)
LIST(Incomplete, ModellingHypotheses, 1, "Tridimensional")
