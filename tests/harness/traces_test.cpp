/// What a store keeps of trajectories: as many poses as their curves need, rounded and compressed.
#include "harness/sweep/store/traces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "datasets/core/so3.hpp"
#include "harness/answers/report/assets.hpp"
#include "harness/answers/report/data.hpp"
#include "tests/support/command.hpp"

namespace loopbench::traces_test {
namespace {

using namespace harness;

constexpr std::size_t kPoses = 50'000;

/// A walk with stops and sharp corners, and an estimate with a drift, jumps, single outliers and
/// noise of this amplitude [m, rad].
metrics::Evaluation jagged(double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  metrics::Evaluation out;
  Vector3 position(3.0, -2.0, 1.0), step(0.1, 0.0, 0.0), drift = Vector3::Zero();
  for (std::size_t i = 0; i < kPoses; ++i) {
    if (i % 400 == 0) step = 0.1 * Vector3(normal(random), normal(random), 0.02 * normal(random));
    if (i % 5000 < 4000) position += step;
    if (i % 7001 == 7000) drift += Vector3(normal(random), normal(random), 0.3 * normal(random));
    drift += 2e-3 * Vector3(normal(random), normal(random), 0.1 * normal(random));
    const auto noisy = [&] { return noise * normal(random); };
    Vector3 error = drift + Vector3(noisy(), noisy(), noisy());
    if (i % 3001 == 3000) error.z() += 4.0;
    const double stamp = 1.5e9 + 0.05 * static_cast<double>(i);
    out.reference.push_back({stamp, {Rotation::Identity(), position}});
    const Rotation rotation =
        exp_so3({noisy(), 0.1 * std::sin(1e-3 * static_cast<double>(i)), 0.0});
    out.estimate.push_back({stamp, {rotation, position + error}});
  }
  return out;
}

/// Columns stamp, distance, x, y, z, error in x, y, z and angle of all poses.
std::vector<std::array<double, 9>> exact(const metrics::Evaluation& e, const TraceOrigin& origin) {
  std::vector<std::array<double, 9>> out;
  double distance = 0.0;
  for (std::size_t i = 0; i < kPoses; ++i) {
    const Pose& expected = e.reference[i].world_from_body;
    const Pose& found = e.estimate[i].world_from_body;
    if (i > 0) {
      distance += (expected.translation - e.reference[i - 1].world_from_body.translation).norm();
    }
    const Vector3 error = found.translation - expected.translation;
    const Vector3 p = found.translation - Vector3(origin.x, origin.y, origin.z);
    const double angle = 180.0 / M_PI * angle_between(expected.rotation, found.rotation);
    out.push_back({e.reference[i].stamp - origin.stamp,
                   distance,
                   p.x(),
                   p.y(),
                   p.z(),
                   error.x(),
                   error.y(),
                   error.z(),
                   angle});
  }
  return out;
}

std::array<double, 9> columns_of(const TraceSample& s) {
  const TracePose& e = s.estimate;
  return {e.stamp, e.distance, e.x, e.y, e.z, s.error_x, s.error_y, s.error_z, s.error_angle};
}

/// Distance of `p` from the line between a and b in two of the columns, each in shares of `size`.
double off(const std::array<double, 9>& a,
           const std::array<double, 9>& b,
           const std::array<double, 9>& p,
           const std::array<double, 9>& size,
           std::size_t x,
           std::size_t y) {
  const double bx = (b[x] - a[x]) / size[x], by = (b[y] - a[y]) / size[y];
  const double px = (p[x] - a[x]) / size[x], py = (p[y] - a[y]) / size[y];
  const double square = bx * bx + by * by;
  const double u = square > 0.0 ? std::clamp((px * bx + py * by) / square, 0.0, 1.0) : 0.0;
  return std::hypot(px - u * bx, py - u * by);
}

/// Two columns that are drawn against each other.
constexpr std::pair<std::size_t, std::size_t> kPanels[] = {
    {2, 3}, {2, 4}, {3, 4}, {0, 5}, {0, 6}, {0, 7}, {0, 8}, {1, 5}, {1, 6}, {1, 7}, {1, 8}};

TEST(Traces, CurvesOfAStoreDeviateFromNoPoseByMoreThanAFifthOfAPercent) {
  for (const double noise : {1e-3, 0.1, 2.0}) {
    const metrics::Evaluation evaluation = jagged(noise, 1);
    const Vector3& p = evaluation.reference.front().world_from_body.translation;
    const TraceOrigin origin{evaluation.reference.front().stamp, p.x(), p.y(), p.z()};
    const CellTrace trace = cell_trace(evaluation, metrics::Times::dense, origin, {});
    const auto stored =
        unpacked_items<TraceSample>(packed_items(trace.samples, kDrawnSteps), kDrawnSteps);
    ASSERT_EQ(stored.size(), trace.samples.size());
    const auto all = exact(evaluation, origin);
    std::array<double, 9> low = all[0], high = all[0], size{};
    for (const auto& row : all) {
      for (std::size_t c = 0; c < 9; ++c) {
        low[c] = std::min(low[c], row[c]);
        high[c] = std::max(high[c], row[c]);
      }
    }
    for (std::size_t c = 0; c < 9; ++c) size[c] = high[c] - low[c];
    for (const std::size_t c : {2u, 3u, 4u}) size[c] = std::max({size[2], size[3], size[4]});

    double worst = 0.0;
    std::size_t next = 1;  // the stored row at or after pose i
    for (std::size_t i = 0; i < kPoses; ++i) {
      while (trace.samples[next].estimate.stamp < static_cast<float>(all[i][0])) ++next;
      const auto a = columns_of(stored[next - 1]), b = columns_of(stored[next]);
      for (const auto& [x, y] : kPanels) worst = std::max(worst, off(a, b, all[i], size, x, y));
    }
    EXPECT_LE(worst, 0.002) << noise;
    EXPECT_GE(worst, 0.001) << noise << ": more poses than needed";
    if (noise < 0.01) EXPECT_LT(stored.size(), kPoses / 20);
  }
}

TEST(Traces, ValuesOfMetricsAreCurvesToo) {
  const metrics::Evaluation evaluation = jagged(1e-3, 2);
  PoseValues peak{"peak", "m", std::vector<double>(kPoses, 1.0)};
  peak.values[12'345] = 2.0;
  const CellTrace trace = cell_trace(evaluation, metrics::Times::dense, {}, {peak});
  ASSERT_EQ(trace.values.size(), 1u);
  const std::vector<float>& kept = trace.values[0].values;
  ASSERT_EQ(kept.size(), trace.samples.size());
  const auto at = std::ranges::max_element(kept);
  EXPECT_EQ(*at, 2.0F);
  EXPECT_EQ(*(at - 1), 1.0F);  // its neighbours are kept
  EXPECT_EQ(*(at + 1), 1.0F);
  const CellTrace coarse = thinned(trace, 0.02);
  EXPECT_LT(coarse.samples.size(), trace.samples.size() / 3);
  EXPECT_EQ(std::ranges::max(coarse.values[0].values), 2.0F);
}

TEST(Traces, ASequenceAtRestOrOfOnePoseIsKept) {
  metrics::Evaluation evaluation;
  EXPECT_TRUE(cell_trace(evaluation, metrics::Times::dense, {}, {}).samples.empty());
  evaluation.reference = {{1.0, {Rotation::Identity(), {1.0, 2.0, 3.0}}}};
  evaluation.estimate = evaluation.reference;
  EXPECT_EQ(cell_trace(evaluation, metrics::Times::dense, {}, {}).samples.size(), 1u);
  for (double stamp : {2.0, 3.0, 4.0}) {
    evaluation.reference.push_back({stamp, evaluation.reference[0].world_from_body});
    evaluation.estimate.push_back(evaluation.reference.back());
  }
  const CellTrace trace = cell_trace(evaluation, metrics::Times::dense, {1.0, 0, 0, 0}, {});
  EXPECT_EQ(trace.samples.front().estimate.stamp, 0.0F);
  EXPECT_EQ(trace.samples.back().estimate.stamp, 3.0F);
}

/// A sweep of two methods on one sequence.
TEST(Traces, OfASweepAreSmallAndReachThePage) {
  const TemporaryFolder folder;
  folder.file("c.yaml",
              "datasets: [{dataset: simulated, path: room}]\n"
              "methods: [raw, dual]\nmetrics: [ate]\nrepeats: 2\n");
  const CommandResult ran = loopbench_command("run c.yaml --out r -j 2", folder);
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const CommandResult alone = loopbench_command("run c.yaml --out s -j 1", folder);
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  Traces traces(folder.path() / "r"), others(folder.path() / "s");
  const auto sizes = traces.sizes();
  EXPECT_EQ(sizes.size(), 4u);
  EXPECT_EQ(sizes, others.sizes());
  for (const auto& [position, bytes] : sizes) {
    EXPECT_LT(bytes, 8'000u);
    const auto one = traces.cell(position), other = others.cell(position);
    ASSERT_TRUE(one && other);
    EXPECT_EQ(packed_items(one->samples, kFineSteps), packed_items(other->samples, kFineSteps));
  }

  if (std::system("command -v node >/dev/null 2>&1") != 0) GTEST_SKIP() << "needs node";
  // The page unpacks the same numbers, and fills long lines up.
  const ReportContent content = read_report_content(folder.path() / "r");
  const nlohmann::json data{{"scores", scores_json(content)},
                            {"comparisons", nlohmann::json::array()},
                            {"traces", traces_json(content, {kTraceDeviation, 2})}};
  const auto script = std::ranges::find(assets(), "page/data.js", &Asset::name);
  folder.file("data.json", data.dump());
  folder.file("data.js",
              "const text = require('fs').readFileSync('data.json', 'utf8');\n"
              "const window = {R: {state: {repeat: 0}}};\n"
              "const document = {getElementById: () => ({textContent: text})};\n" +
                  std::string(script->text) +
                  "const t = window.R.trace(0, 0);\n"
                  "const all = ['t', 's', 'x', 'y', 'z', 'ex', 'ey', 'ez', 'a'].map((k) => "
                  "Array.from(t[k]));\n"
                  "require('fs').writeFileSync('out.json', JSON.stringify(all));\n");
  ASSERT_EQ(std::system(("cd '" + folder.path().string() + "' && node data.js").c_str()), 0);
  std::ifstream file(folder.path() / "out.json");
  const auto all = nlohmann::json::parse(file).get<std::vector<std::vector<double>>>();
  const auto trace = traces.cell(0);
  std::size_t row = 0;
  double last = 0.0;
  for (std::size_t i = 0; i < all[0].size(); ++i) {
    EXPECT_LE(all[0][i] - last, all[0].back() / 400.0 + 1e-9);
    last = all[0][i];
    const auto expected = columns_of(trace->samples[row]);
    bool is_same = true;
    for (std::size_t c = 0; c < 9; ++c) {
      is_same =
          is_same && std::abs(all[c][i] - expected[c]) <= 1e-6 * (1.0 + std::abs(expected[c]));
    }
    if (is_same && row + 1 < trace->samples.size()) ++row;
  }
  EXPECT_EQ(row + 1, trace->samples.size()) << "each stored pose is drawn, in order";
}

}  // namespace
}  // namespace loopbench::traces_test
