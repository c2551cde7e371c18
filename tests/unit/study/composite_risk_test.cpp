#include <gtest/gtest.h>

#include <cmath>

#include "uplift/study/study_fit.h"

// The annual rate by the components of variance beside that of the fit.
namespace uplift {
namespace {

/// A hazard k0 a^-k that is a straight line in logarithms: rate k0 theta^-k exp(k^2 beta^2/2), Cornell (1996), with the composite beta
/// sqrt(0.3^2 + 0.1^2 + 0.2^2), beta^2 = 0.14. By hand: 1e-4 x 4^-2 x exp(4 x 0.14/2) = 8.2695e-6.
TEST(CompositeRisk, ByHand) {
  StudySite site;
  for (const double im : {0.1, 1.0, 10.0, 100.0}) site.hazard.push_back({im, 1e-4 * std::pow(im, -2)});
  TwoWayLayout layout;
  layout.median = 4;
  layout.beta_r = 0.3, layout.beta_interaction = 0.1, layout.beta_u = 0.2;
  const OrRefused<AnnualRisk> risk = composite_risk_of(site, layout);
  ASSERT_TRUE(std::holds_alternative<AnnualRisk>(risk));
  EXPECT_NEAR(std::get<AnnualRisk>(risk).rate, 8.2695e-6, 1e-10);
  EXPECT_TRUE(std::holds_alternative<Refused>(composite_risk_of(site, Refused{"one sample"})));
}

TEST(Fragility, OneCapacityHasNoScatter) {
  const OrRefused<Fragility> fit = fit_capacities(std::vector<RecordCapacity>{{.im = 2}});
  ASSERT_TRUE(std::holds_alternative<Refused>(fit));
  EXPECT_NE(std::get<Refused>(fit).reason.find("two at least"), std::string::npos);
}

}  // namespace
}  // namespace uplift
