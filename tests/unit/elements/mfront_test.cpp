// Behaviours of a shared library with the generic interface of MFront, written by hand (tests/mfront_behaviours.c): closed forms, the same
// law of the program, refusals.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "data_support.h"
#include "text_support.h"
#include "uplift/base/file.h"
#include "uplift/elements/bulk_laws/drucker_prager.h"
#include "uplift/io/text/toml.h"

namespace uplift::mfront_test {
namespace {

const ElasticMaterial material{5e7, 0.3, 1900};

Values law_values(const std::string& behaviour, const std::string& rest) {
  const std::string text = "[law]\ntype = \"mfront\"\nlibrary = \"" UPLIFT_MFRONT_LIBRARY "\"\nbehaviour = \"" + behaviour + "\"\n" + rest;
  const Raw file = read_toml_text(text, "case.toml");
  return check_part(*std::get<std::shared_ptr<RawTable>>(file.data)->find("law"), bulk_laws());
}

std::shared_ptr<const BulkLaw> law_of(const std::string& behaviour, const std::string& rest = {}, int dimension = 3) {
  return make_part(bulk_law_catalog(), law_values(behaviour, rest), {material, dimension});
}

std::string refusal(const std::string& behaviour, const std::string& rest = {}, int dimension = 3) {
  return support::refusal_of([&] { law_of(behaviour, rest, dimension); });
}

struct Point {
  explicit Point(const BulkLaw& of) : law(of), old(static_cast<std::size_t>(law.num_history()), 0.0), now(old) {}
  BulkResponse respond(const Strain& strain, double duration = 0) {
    return law.respond({{&strain, 1}, old.data(), now.data(), &stress, &tangent, duration});
  }
  void go(const Strain& strain, double duration = 0) {
    const BulkResponse response = respond(strain, duration);
    ASSERT_TRUE(response.converged) << response.why;
    old = now;
  }
  const BulkLaw& law;
  std::vector<double> old, now;
  Stress stress;
  Mat6 tangent;
};

Strain random_strain(std::mt19937& random, double size, int dimension) {
  std::uniform_real_distribution<double> uniform(-size, size);
  Strain strain;
  for (double& each : strain) each = uniform(random);
  if (dimension == 2) strain[2] = strain[4] = strain[5] = 0;
  return strain;
}

TEST(Mfront, LinearBehaviourIsHookesLaw) {
  std::mt19937 random(1);
  for (const int dimension : {2, 3}) {
    const auto law = law_of("Linear", {}, dimension);
    const Mat6 d = elastic_matrix(material);
    Point point(*law);
    for (int step = 0; step < 20; ++step) {
      const Strain strain = random_strain(random, 1e-3, dimension);
      point.go(strain);
      EXPECT_LE((point.stress - d * strain).norm(), 1e-14 * material.constrained() * 1e-3);
      EXPECT_LE((point.tangent - d).norm(), 1e-14 * d.norm());
      for (int i = 0; i < 6; ++i) EXPECT_EQ(point.now[static_cast<std::size_t>(i)], 0);  // round-off is no inelastic strain
    }
  }
}

const std::string cone =
    "properties = { Cohesion = \"20 kPa\", FrictionAngle = \"30 deg\", DilatancyAngle = 0.1, HardeningSlope = \"2 MPa\" }\n";

DruckerPragerParameters same_cone() {
  DruckerPragerParameters p;
  p.elastic = material;
  p.cohesion = 2e4;
  p.friction = M_PI / 6;
  p.dilation = 0.1;
  p.hardening = 2e6;
  return p;
}

TEST(Mfront, DruckerPragerOfTheLibraryIsThatOfTheProgram) {
  std::mt19937 random(2);
  const DruckerPrager own(same_cone());
  for (const int dimension : {2, 3}) {
    const auto law = law_of("DruckerPrager", cone, dimension);
    int yielded = 0;
    for (int path = 0; path < 50; ++path) {
      Point theirs(*law), ours(own);
      const double size = path % 2 == 0 ? 5e-4 : 5e-3, scale = material.constrained() * size;
      for (int step = 0; step < 6; ++step) {
        const Strain strain = random_strain(random, size, dimension);
        theirs.go(strain);
        ours.go(strain);
        yielded += ours.old[6] > 0;
        ASSERT_LE((theirs.stress - ours.stress).norm(), 1e-12 * scale);
        const int n = dimension == 2 ? 4 : 6;  // in plane strain the other rows are not used
        ASSERT_LE((theirs.tangent - ours.tangent).topLeftCorner(n, n).norm(), 1e-10 * material.constrained());
        for (std::size_t i = 0; i < 6; ++i) ASSERT_NEAR(theirs.old[i], ours.old[i], 1e-12 * size);
        double accumulated = 0;
        law->find_outputs(theirs.old.data(), &accumulated);
        ASSERT_NEAR(accumulated, ours.old[6], 1e-12 * size);
      }
    }
    EXPECT_GT(yielded, 100);
  }
}

TEST(Mfront, TensorsOfTheLibraryHaveItsOrderAndFactors) {
  // Shear of one plane that yields: the plastic strain of the library has this component alone, gamma/sqrt(2), as xy, xz, yz.
  const auto law = law_of("DruckerPrager", cone);
  const struct { int ours, theirs; } planes[] = {{3, 3}, {5, 4}, {4, 5}};
  for (const auto& plane : planes) {
    Point point(*law);
    Strain strain = Strain::Zero();
    strain[plane.ours] = 0.01;
    point.go(strain);
    const double* plastic = point.old.data() + 13 + 1;  // after the accumulated plastic strain
    EXPECT_GT(plastic[plane.theirs], 1e-3);
    EXPECT_NEAR(plastic[plane.theirs], point.old[static_cast<std::size_t>(plane.ours)] / std::sqrt(2), 1e-15);
    for (int k = 3; k < 6; ++k)
      if (k != plane.theirs) EXPECT_EQ(plastic[k], 0) << k;
  }
  ASSERT_EQ(law->outputs().size(), 1u);  // the scalar variable
  EXPECT_EQ(law->outputs()[0].name, "EquivalentPlasticStrain");
}

TEST(Mfront, StateOfTheNaturalStateIsThatOfTheCase) {
  // An accumulated plastic strain e0 from the beginning is a cohesion larger by H e0.
  const auto begun = law_of("DruckerPrager", cone + "state = { EquivalentPlasticStrain = 0.01 }\n");
  DruckerPragerParameters stronger = same_cone();
  stronger.cohesion += stronger.hardening * 0.01;
  const DruckerPrager own(stronger);
  Point theirs(*begun), ours(own);
  double state = 0;
  begun->find_outputs(theirs.old.data(), &state);
  EXPECT_EQ(state, 0.01);
  for (const double shear : {1e-4, 2e-3, -3e-3}) {
    Strain strain = Strain::Zero();
    strain[3] = shear;
    theirs.go(strain);
    ours.go(strain);
    EXPECT_LE((theirs.stress - ours.stress).norm(), 1e-11 * ours.stress.norm());
  }
  begun->find_outputs(theirs.old.data(), &state);
  EXPECT_NEAR(state, 0.01 + ours.old[6], 1e-15);
}

TEST(Mfront, StoredEnergyOfTheLibraryIsLocked) {
  // Simple shear with Prager's hardening: plastic shear strain g_p = (G g - t)/(G + H/3), t = Y/sqrt(3), locked energy H g_p^2/6.
  const double strength = 2e4, hardening = 6e6, shear = material.shear(), gamma = 3e-3;
  for (const int dimension : {2, 3}) {  // for plane strain the library has the behaviour for three dimensions
    const auto law = law_of("Prager", "properties = { YieldStrength = \"20 kPa\", HardeningSlope = 6e6 }\n", dimension);
    Point point(*law);
    Strain strain = Strain::Zero();
    strain[3] = gamma;
    point.go(strain);
    const double plastic = (shear * gamma - strength / std::sqrt(3)) / (shear + hardening / 3);
    EXPECT_NEAR(point.stress[3], shear * (gamma - plastic), 1e-12 * shear * gamma);
    EXPECT_NEAR(law->locked_energy(point.old.data()), hardening * plastic * plastic / 6, 1e-12 * shear * gamma * gamma);
    strain[3] = 0.9 * gamma;  // back without yielding: the memory stays
    point.go(strain);
    EXPECT_NEAR(point.stress[3], shear * (0.9 * gamma - plastic), 1e-12 * shear * gamma);
    EXPECT_NEAR(law->locked_energy(point.old.data()), hardening * plastic * plastic / 6, 1e-12 * shear * gamma * gamma);
  }
}

TEST(Mfront, TheDurationOfTheStepReachesTheLibrary) {
  // Maxwell's fluid, implicit: with the shear strain held the stress is divided by 1 + G dt/viscosity in every step.
  const double viscosity = 1e6, step = 0.01, gamma = 1e-3, shear = material.shear();
  const auto law = law_of("Maxwell", "properties.Viscosity = \"1 MPa s\"\n");
  Point point(*law);
  Strain strain = Strain::Zero();
  strain[4] = gamma;
  point.go(strain, 0);
  EXPECT_NEAR(point.stress[4], shear * gamma, 1e-13 * shear * gamma);
  for (int k = 1; k <= 10; ++k) {
    point.go(strain, step);
    EXPECT_NEAR(point.stress[4], shear * gamma / std::pow(1 + shear * step / viscosity, k), 1e-12 * shear * gamma);
  }
}

TEST(Mfront, AFailureHasTheReasonOfTheLibrary) {
  const auto brittle = law_of("Brittle", "properties = { StrainLimit = 1e-3 }\n");
  Strain strain = Strain::Zero();
  strain[0] = 9e-4;
  Point point(*brittle);
  EXPECT_TRUE(point.respond(strain).converged);
  strain[0] = 1.1e-3;
  const BulkResponse refused = point.respond(strain);
  EXPECT_FALSE(refused.converged);
  EXPECT_EQ(refused.why, "behaviour \"Brittle\" of MFront: the strain is beyond StrainLimit");
  const auto impatient = law_of("Impatient"), silent = law_of("Silent");
  Point hurried(*impatient), mute(*silent);
  EXPECT_TRUE(hurried.respond(strain, 1e-3).converged);
  EXPECT_EQ(hurried.respond(strain, 2e-3).why, "behaviour \"Impatient\" of MFront: it asks for a shorter step");
  EXPECT_EQ(mute.respond(strain).why, "behaviour \"Silent\" of MFront: the integration of the step failed");
}

void expect_refusal(const std::string& found, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(found.find(part), std::string::npos) << part << "\nin: " << found;
}

TEST(Mfront, RefusesALibraryThatDoesNotFit) {
  const auto refused_library = [](const std::string& library) {
    return support::refusal_of([&] {
      const Raw file = read_toml_text("[law]\ntype = \"mfront\"\nlibrary = \"" + library + "\"\nbehaviour = \"Linear\"\n",
                                      support::source_folder() + "/tests/case.toml");
      make_part(bulk_law_catalog(), check_part(*std::get<std::shared_ptr<RawTable>>(file.data)->find("law"), bulk_laws()), {material, 3});
    });
  };
  expect_refusal(refused_library("mfront_behaviors.c"),
                 {"case.toml:3: law.library", "a shared library", "no file", "did you mean", "mfront_behaviours.c"});
  expect_refusal(refused_library("mfront_behaviours.c"), {"case.toml:3: law.library", "a shared library", "invalid ELF header"});
  expect_refusal(refused_library("/dev/zero"), {"\"/dev/zero\", which is no regular file"});
  // a copy that ended early: the loader would map it, and the process would be killed
  const std::filesystem::path cut = std::filesystem::temp_directory_path() / fmt::format("cut_{}.so", ::getpid());
  const std::string whole = read_file(UPLIFT_MFRONT_LIBRARY);
  for (const std::size_t bytes : {whole.size() - 1, whole.size() / 2}) {
    std::ofstream(cut, std::ios::binary) << whole.substr(0, bytes);
    expect_refusal(refused_library(cut.string()), {"case.toml:3: law.library", "a shared library", "whose end is missing"});
  }
  std::filesystem::remove(cut);
}

TEST(Mfront, RefusesABehaviourThatDoesNotFit) {
  expect_refusal(refusal("Liner"), {"case.toml:4: law.behaviour", "Linear", "found \"Liner\"", "did you mean \"Linear\""});
  expect_refusal(refusal("PlaneOnly"), {"case.toml:4: law.behaviour", "Tridimensional", "one for PlaneStrain or Axisymmetrical"});
  EXPECT_EQ(refusal("PlaneOnly", {}, 2), "accepted");
  expect_refusal(refusal("OtherInterface"), {"--interface=generic", "\"Castem\""});
  expect_refusal(refusal("OldInterface"), {"TFEL 3.4.1", "version 0"});
  expect_refusal(refusal("FiniteStrain"), {"small strains"});
  expect_refusal(refusal("Orthotropic"), {"isotropic"});
  expect_refusal(refusal("Humid"), {"external state variables", "Humidity"});
  expect_refusal(refusal("Incomplete"), {"no symbol \"Incomplete_Tridimensional\""});
}

TEST(Mfront, RefusesParametersThatDoNotFit) {
  expect_refusal(refusal("Brittle"), {"case.toml:1: law.properties", "1 material properties: StrainLimit", "no \"StrainLimit\""});
  expect_refusal(refusal("Brittle", "properties = { StrainLimit = 1e-3, Strength = 3 }\n"),
                 {"case.toml:5: law.properties.Strength", "StrainLimit", "found \"Strength\""});
  expect_refusal(refusal("Brittle", "properties = { StrainLimt = 1e-3 }\n"), {"did you mean \"StrainLimit\""});
  expect_refusal(refusal("Brittle", "properties = { StrainLimit = 1e-3, YoungModulus = 5e7 }\n"), {"from E of the solid"});
  expect_refusal(refusal("Brittle", "properties = { StrainLimit = \"3 quux\" }\n"), {"case.toml:5", "a number", "\"3 quux\""});
  expect_refusal(refusal("Brittle", "properties = { StrainLimit = -1 }\n"),
                 {"case.toml:4: law.behaviour", "StrainLimit is out of its bounds"});
  expect_refusal(refusal("Linear", "properties = { Cohesion = 1 }\n"), {"no material property except those of the solid"});
  expect_refusal(refusal("DruckerPrager", cone + "state = { PlasticStrain = 1 }\n"), {"case.toml:6", "EquivalentPlasticStrain"});
  expect_refusal(refusal("Linear", "state = { x = 1 }\n"), {"no scalar internal state variable"});
}

}  // namespace
}  // namespace uplift::mfront_test
