#include <gtest/gtest.h>

#include "manifold_paths.hpp"
#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::methods::manifold::manifold_bspline_test {
namespace {

using Value = BSpline::Value;

const std::vector<double> kSites{0.0, 0.4, 1.0, 1.3, 2.1, 2.5, 3.4, 4.0};

std::vector<Value> values_of(const std::function<Value(double)>& f) {
  std::vector<Value> out;
  for (const double u : kSites) out.push_back(f(u));
  return out;
}
Value smooth_function(double u) { return {std::sin(u), std::cos(2 * u), u * u, 1.0 / (1.0 + u)}; }
Value cubic(double u) { return {u * u * u - u, 2.0 - u * u, 0.5 * u * u * u, u}; }

// Corrected equation (12), implemented literally and slowly.
double N(const std::vector<double>& m, std::size_t t, std::size_t k, double u) {
  if (k == 1) return m[t] <= u && u < m[t + 1] ? 1.0 : 0.0;
  const auto share = [](double above, double below) { return below == 0.0 ? 0.0 : above / below; };
  return share(u - m[t], m[t + k - 1] - m[t]) * N(m, t, k - 1, u) +
         share(m[t + k] - u, m[t + k] - m[t + 1]) * N(m, t + 1, k - 1, u);
}

class EveryOrder : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(BSpline, EveryOrder, testing::Values(2u, 3u, 4u, 5u, 6u));

TEST_P(EveryOrder, BasisIsTheRecursion) {
  const std::size_t k = GetParam();
  const SplineBasis basis = SplineBasis::for_sites(k, kSites);
  std::vector<double> knots(k - 1, basis.breaks().front());
  knots.insert(knots.end(), basis.breaks().begin(), basis.breaks().end());
  knots.insert(knots.end(), k - 1, basis.breaks().back());
  for (double u = 0.0; u < 4.0; u += 0.037) {
    const std::size_t piece = basis.piece_at(u);
    const auto values = basis.values(piece, u);
    for (std::size_t j = 0; j < k; ++j) {
      EXPECT_NEAR(values[j], N(knots, piece + j, k, u), 1e-12) << u;
    }
  }
}

TEST_P(EveryOrder, PassesThroughEverySite) {
  const auto values = values_of(smooth_function);
  const BSpline spline = BSpline::through(kSites, values, GetParam());
  for (std::size_t i = 0; i < kSites.size(); ++i) {
    EXPECT_NEAR((spline.at(kSites[i]) - values[i]).norm(), 0.0, 1e-12) << i;
  }
}

TEST_P(EveryOrder, JetsAgreeWithDifferences) {
  if (GetParam() < 4) return;  // the second derivative is not continuous
  const BSpline spline = BSpline::through(kSites, values_of(smooth_function), GetParam());
  const double h = 1e-4, u = 1.55;
  const Jet<Value> jet = spline.at(time_jet(u));
  EXPECT_NEAR((jet.first - (spline.at(u + h) - spline.at(u - h)) / (2 * h)).norm(), 0.0, 1e-5);
  EXPECT_LT(
      (jet.second - (spline.at(u + h) - 2 * spline.at(u) + spline.at(u - h)) / (h * h)).norm(),
      1e-4);
}

TEST(BSpline, ReproducesCubicsFromOrderFourOn) {
  for (const std::size_t k : {4u, 5u, 6u}) {
    const BSpline spline = BSpline::through(kSites, values_of(cubic), k);
    for (double u = 0.0; u <= 4.0; u += 0.1) {
      EXPECT_NEAR((spline.at(u) - cubic(u)).norm(), 0.0, 1e-10) << k << " " << u;
    }
  }
}

TEST(NodeSpline, PolylineIsStraightBetweenNodes) {
  const Nodes nodes(through({{0, 0, 0}, {1, 0, 0}, {1, 2, 0}}));
  EXPECT_TRUE(NodeSpline::polyline(nodes).at(1, 1.25).point.isApprox(Vector3(1, 0.5, 0), 1e-15));
}

}  // namespace
}  // namespace loopbench::methods::manifold::manifold_bspline_test
