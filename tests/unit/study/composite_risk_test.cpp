#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "uplift/io/results/study_json.h"
#include "uplift/study/study_fit.h"

// The annual rate by the components of variance beside that of the fit.
namespace uplift::composite_risk_test {
namespace {

/// A hazard k0 a^-k that is a straight line in logarithms: rate k0 theta^-k exp(k^2 beta^2/2), Cornell (1996), with the composite beta
/// sqrt(0.3^2 + 0.1^2 + 0.2^2), beta^2 = 0.14. By hand: 1e-4 x 4^-2 x exp(4 x 0.14/2) = 8.2695e-6.
TEST(CompositeRisk, ByHand) {
  StudySite site;
  for (const double im : {0.1, 1.0, 10.0, 100.0}) site.hazard.push_back({im, 1e-4 * std::pow(im, -2)});
  StudyLimitFit fit;
  TwoWayLayout layout;
  layout.median = 4;
  layout.beta_r = 0.3, layout.beta_interaction = 0.1, layout.beta_u = 0.2;
  fit.layout = layout;
  const OrRefused<AnnualRisk> risk = composite_risk_of(site, seismic_capacity(site, fit, true));
  ASSERT_TRUE(std::holds_alternative<AnnualRisk>(risk));
  EXPECT_NEAR(std::get<AnnualRisk>(risk).rate, 8.2695e-6, 1e-10);
  fit.layout = Refused{"one sample"};
  EXPECT_TRUE(std::holds_alternative<Refused>(composite_risk_of(site, seismic_capacity(site, fit, true))));
}

/// Factors of safety 1.5 (0.1, 0.2) and 0.8 (0, 0.15) on a capacity of 4 with beta_r^2 = 0.10 and beta_u = 0.2, by hand:
/// A_m = 4 x 1.2 = 4.8; beta_r^2 = 0.11; beta_u^2 = 0.04 + 0.04 + 0.0225 = 0.1025; HCLPF = 4.8 exp(-1.65 (0.331662 + 0.320156)) = 1.63741;
/// of the composite curve 4.8 exp(-2.326 sqrt(0.2125)) = 1.64277. At the design motion 2.4: Phi(-ln 2/0.460977) = Phi(-1.503648) = 0.06634.
TEST(SeismicCapacity, WithFactorsOfSafety) {
  StudySite site;
  site.factors = {{"strength", 1.5, 0.1, 0.2}, {"shape", 0.8, 0, 0.15}};
  site.design = 2.4;
  StudyLimitFit fit;
  TwoWayLayout layout;
  layout.median = 4;
  layout.beta_r = 0.3, layout.beta_interaction = 0.1, layout.beta_u = 0.2;
  fit.layout = layout;
  const OrRefused<SeismicCapacity> result = seismic_capacity(site, fit, true);
  const SeismicCapacity& capacity = std::get<SeismicCapacity>(result);
  EXPECT_NEAR(capacity.median, 4.8, 1e-12);
  EXPECT_NEAR(capacity.beta_r, std::sqrt(0.11), 1e-12);
  EXPECT_NEAR(capacity.beta_u, std::sqrt(0.1025), 1e-12);
  EXPECT_NEAR(capacity.hclpf(), 1.63741, 1e-5);
  EXPECT_NEAR(capacity.hclpf_composite(), 1.64277, 1e-5);
  EXPECT_NEAR(composite_performance_of(site, result)->at_design, 0.06634, 1e-5);
}

/// Without samples the beta of the fit is that of the motions; what is uncertain must come from a factor. Capacities 2 and 8: median 4,
/// beta = ln(2) sqrt(2) = 0.980258.
TEST(SeismicCapacity, OfOneSampleTakesTheUncertaintyFromFactors) {
  StudySite site;
  StudyLimitFit fit;
  fit.fit.middle = fit_capacities(std::vector<RecordCapacity>{{.im = 2}, {.im = 8}});
  const OrRefused<SeismicCapacity> without = seismic_capacity(site, fit, false);
  ASSERT_TRUE(std::holds_alternative<Refused>(without));
  EXPECT_NE(std::get<Refused>(without).reason.find("[[factor]]"), std::string::npos);
  site.factors = {{"soil", 1, 0, 0.3}};
  const SeismicCapacity capacity = std::get<SeismicCapacity>(seismic_capacity(site, fit, false));
  EXPECT_NEAR(capacity.median, 4, 1e-12);
  EXPECT_NEAR(capacity.beta_r, 0.980258, 1e-6);
  EXPECT_NEAR(capacity.beta_u, 0.3, 1e-12);
  // sampled numbers that cannot be told from the motions: part of the scatter would be counted twice
  fit.layout = Refused{"paired"};
  EXPECT_EQ(std::get<Refused>(seismic_capacity(site, fit, true)).reason, "paired");
  fit.fit.middle = Refused{"no curve"};
  EXPECT_EQ(std::get<Refused>(seismic_capacity(site, fit, false)).reason, "no curve");
}

/// The sentence of a limit tells both rates. Capacities 2 and 8 have the logarithmic mean of 4 and the deviation ln(2) sqrt(2) = 0.98, with
/// divisor 1; the rate of the fit by Cornell's formula too. Without a layout the composite rate is left out, without a hazard curve both.
TEST(CompositeRisk, InTheSentenceOfALimit) {
  StudyDocument study;
  study.plan.intensity.unit = "g_n";
  for (const double im : {1e-3, 1e-1, 1e1, 1e3}) study.plan.site.hazard.push_back({im, 1e-4 * std::pow(im, -2)});
  StudyDocument::Limit limit;
  limit.limit.name = "gap";
  limit.fit.survived = 3, limit.fit.exceeded = 2;
  limit.fit.fit.middle = fit_capacities(std::vector<RecordCapacity>{{.im = 2}, {.im = 8}});
  const Fragility& fit = std::get<Fragility>(limit.fit.fit.middle);
  TwoWayLayout layout;
  layout.median = 4;
  layout.beta_r = 0.3, layout.beta_interaction = 0.1, layout.beta_u = 0.2;
  limit.fit.layout = layout;
  limit.fit.capacity = layout.capacity();
  study.limits.push_back(limit);
  const auto said = [&] { return study_sentence(study, 0); };
  const std::string of_fit = fmt::format("; annual rate {:.3g}", 1e-4 * std::pow(fit.theta(), -2) * std::exp(2 * fit.beta() * fit.beta()));
  EXPECT_NE(said().find(of_fit + " (with the composite beta of motions and samples 8.27e-06)"), std::string::npos) << said();
  // HCLPF = 4 exp(-1.65 (sqrt(0.1) + 0.2)) = 1.70663
  EXPECT_NE(said().find("; HCLPF 1.71 g_n;"), std::string::npos) << said();
  study.limits[0].fit.layout = Refused{"one sample"};
  study.limits[0].fit.capacity = Refused{"one sample"};
  EXPECT_TRUE(said().ends_with(of_fit)) << said();
  // The median is exceeded in half of the cases; at ten times the median Phi(2.35) = 0.991.
  study.plan.site.design = 4.0;
  EXPECT_NE(said().find("at the design motion 50 %"), std::string::npos) << said();
  study.plan.site.design = 40.0;
  EXPECT_NE(said().find("at the design motion above 99 %, at 1.5 times it above 99 %"), std::string::npos) << said();
  study.plan.site.design.reset();
  study.plan.site.hazard.clear();
  EXPECT_EQ(said().find("annual rate"), std::string::npos) << said();
}

TEST(Fragility, OneCapacityHasNoScatter) {
  const OrRefused<Fragility> fit = fit_capacities(std::vector<RecordCapacity>{{.im = 2}});
  ASSERT_TRUE(std::holds_alternative<Refused>(fit));
  EXPECT_NE(std::get<Refused>(fit).reason.find("two at least"), std::string::npos);
}

}  // namespace
}  // namespace uplift::composite_risk_test
