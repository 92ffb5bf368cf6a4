#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/metrology/study/gauge_rr.hpp"
#include "core/metrology/study/gauge_type1.hpp"
#include "core/metrology/uncertainty/decision.hpp"
#include "tests/core/metrology/reference/reference_case.hpp"

namespace fvd::metrology::reference {
namespace {

TEST(StudyCase, EighteenIsATypeOneStudy) {
  ReferenceCase reference(18, 50);
  std::vector<double> values(25, 50.1);
  values.insert(values.end(), 25, 49.9);
  GaugeType1Settings settings;
  settings.reference = 50.0;
  settings.tolerance = 4.0;

  const GaugeType1 study = gauge_type1(values, settings);

  const long double sd = 0.1L * std::sqrt(50.0L / 49.0L);
  reference.compare("s", study.sd, sd, 0.1010153, 5e-8);
  reference.compare("Cg", study.cg.value(), 0.8L / (6.0L * sd), 1.319933, 5e-7);
  reference.compare("Cgk", study.cgk.value(), 0.4L / (3.0L * sd), 1.319933, 5e-7);
  EXPECT_FALSE(study.capable);
}

TEST(StudyCase, NineteenIsAnAnalysisOfVariance) {
  ReferenceCase reference(19, 12);
  std::vector<double> values;
  for (int part = 0; part < 3; ++part) {
    for (const double person : {0.0, 0.2}) {
      for (const double trial : {0.1, -0.1}) values.push_back(part + person + trial);
    }
  }
  GaugeRrSettings settings;
  settings.parts = 3;
  settings.operators = settings.trials = 2;

  const GaugeRr study = gauge_rr(values, settings);

  // By hand: sums of squares parts 8, operators 0.12, interaction 0, trials 0.12; pooled over 8 degrees of freedom.
  const long double within = 0.12L / 8.0L;
  const long double between = (0.12L - within) / 6.0L;
  const long double of_parts = (8.0L / 2.0L - within) / 4.0L;
  const long double gauge = within + between;
  EXPECT_TRUE(study.interaction_pooled);
  reference.compare("EV", study.ev, std::sqrt(within), 0.1224745, 5e-8);
  reference.compare("AV", study.av, std::sqrt(between), 0.1322876, 5e-8);
  reference.compare("GRR", study.grr, std::sqrt(gauge), 0.1802776, 5e-8);
  reference.compare("PV", study.pv, std::sqrt(of_parts), 0.9981233, 1e-7);
  reference.compare("%GRR", study.grr_of_total_percent.value(), 100.0L * std::sqrt(gauge / (gauge + of_parts)), 17.774,
                    5e-4);
  reference.compare("ndc", study.ndc.value(), 7.0L, 7.0, 0.0);
}

TEST(StudyCase, TwentyIsADecisionBetweenLimits) {
  ReferenceCase reference(20, 1);
  const CombinedUncertainty u{0.03, kInfiniteDof, 2.0, 0.06, 0.95};
  const Limits limits{49.9, 50.1};
  // The value from which on a decision is a pass, less the lower limit.
  const auto passes_from = [&](DecisionRule rule) {
    double low = 49.9;
    double high = 50.0;
    for (int i = 0; i < 50; ++i) {
      const double middle = (low + high) / 2.0;
      (decide(middle, u, limits, {rule, 0.95}).verdict == Verdict::kPass ? high : low) = middle;
    }
    return high - 49.9;
  };
  const auto below = [](long double x) { return std::erfc(-x / std::sqrt(2.0L)) / 2.0L; };
  long double low = 0.0L;
  long double high = 0.1L;
  for (int i = 0; i < 60; ++i) {
    const long double middle = (low + high) / 2.0L;
    (below((0.2L - middle) / 0.03L) - below(-middle / 0.03L) >= 0.95L ? high : low) = middle;
  }

  reference.compare("probability", passes_from(DecisionRule::kIso14253), high, 0.04935, 5e-6);
  reference.compare("guard band U", passes_from(DecisionRule::kGuardU), 0.06L, 0.06, 0.0);
}

}  // namespace
}  // namespace fvd::metrology::reference
