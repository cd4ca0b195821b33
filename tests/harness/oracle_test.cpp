#include <gtest/gtest.h>

#include <numbers>

#include "harness/answers/tables/pivot.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/run/run_cell.hpp"
#include "harness/sweep/store/store.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::oracle_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

/// Built-in methods, and the oracles of results/paper.
Catalogue readings() { return catalogue({LOOPBENCH_PAPER_PLUGIN}); }

/// Along y = 0.1 x^2, one step per second at uneven speed: on the nominal path at integer seconds.
Pose on_parabola(double t) {
  const double x = t + 0.2 * std::sin(2.0 * std::numbers::pi * t) / std::numbers::pi;
  return {Rotation::Identity(), Vector3(x, 0.1 * x * x, 0.3)};
}

Sequence parabola() {
  Sequence out;
  for (int k = 0; k <= 80; ++k) out.reference.push_back({0.1 * k, on_parabola(0.1 * k)});
  for (int k = 0; k <= 8; ++k) out.problem.keyframes.push_back({1.0 * k, on_parabola(k)});
  return out;
}

const Params kWorldAxes{{"planar", std::int64_t{3}},
                        {"frame", std::string("world")},
                        {"guard", false},
                        {"speed_band", 100.0}};

CellResult run(const std::vector<Choice>& stages, const Sequence& sequence) {
  Sweep sweep;
  sweep.datasets.emplace_back();
  sweep.methods = {{"it", stages}};
  sweep.metrics = {{"ate", {"ate", {}}}};
  return run_cell({}, sweep, sequence, readings());
}

double dense_ate(const CellResult& result) {
  for (const ScoreResult& s : result.scores) {
    if (s.times == Times::dense && s.score.relation == "translation") {
      return s.score.statistics.rmse;
    }
  }
  ADD_FAILURE() << result.why;
  return -1.0;
}

TEST(Oracle, AskedAtTheReferencesAbscissaMakesUpForWhatTheKeyframesNeverKnew) {
  const Sequence sequence = parabola();
  // Between keyframes the true x deviates by up to 0.06 m, which is not visible at the keyframes.
  EXPECT_GT(dense_ate(run({{"dm", kWorldAxes}}, sequence)), 0.04);
  EXPECT_NEAR(dense_ate(run({{"paper_oracle", kWorldAxes}}, sequence)), 0.0, 1e-9);
}

TEST(Oracle, WithoutTheReferencesAbscissaIsTheMethodItself) {
  Params options = kWorldAxes;
  const Sequence sequence = parabola();
  const double plain = dense_ate(run({{"dm", options}}, sequence));
  options["reference_abscissa"] = false;
  EXPECT_EQ(dense_ate(run({{"paper_oracle", options}}, sequence)), plain);
}

TEST(Oracle, ChoosesNoWorseThanAnyOneFamily) {
  Sequence sequence = parabola();
  for (std::size_t k = 1; k < 8; ++k) {  // a different wave in every window
    Vector3& p = sequence.problem.keyframes[k].world_from_body.translation;
    p.y() += 0.05 * std::sin(2.0 * static_cast<double>(k * k));
  }
  Params options{{"planar", std::int64_t{5}}, {"joint", std::string("none")}};
  double best = 1.0;
  for (const char* family : {"line", "poly2", "poly3"}) {
    options["families"] = std::string(family);
    best = std::min(best, dense_ate(run({{"dm", options}}, sequence)));
  }
  options["families"] = std::string("line poly2 poly3");
  EXPECT_LE(dense_ate(run({{"paper_oracle_families", options}}, sequence)), 1.01 * best);
}

TEST(Oracle, IsFlaggedInItsResultAloneOrBehindACorrector) {
  const Sequence sequence = parabola();
  EXPECT_TRUE(run({{"paper_oracle", {}}}, sequence).oracle_method);
  EXPECT_TRUE(run({{"raw", {}}, {"paper_oracle", {}}}, sequence).oracle_method);
  EXPECT_FALSE(run({{"dm", {}}}, sequence).oracle_method);
}

TEST(Oracle, DeclinesWithoutAReference) {
  Sequence sequence = parabola();
  sequence.reference.clear();
  const CellResult result = run({{"paper_oracle", {}}}, sequence);
  EXPECT_EQ(result.status, Status::declined);
  EXPECT_EQ(result.why, "an oracle needs a reference");
}

TEST(Oracle, MadeFromTheListOfMethodsHasSeenNothing) {
  const Catalogue known = readings();
  std::size_t oracles = 0;
  for (const MethodEntry& method : known.methods) {
    if (!method.make_oracle) continue;
    ++oracles;
    const Stage stage = method.make({});
    const auto& smoother = std::get<std::unique_ptr<const Smoother>>(stage);
    EXPECT_NE(smoother->why_declined(parabola().problem), "") << method.name;
  }
  EXPECT_EQ(oracles, 5u);
  EXPECT_TRUE(is_oracle(known, "paper_text"));
  EXPECT_FALSE(is_oracle(known, "dm"));
}

TEST(Oracle, RefusesTheOptionsThatDmRefuses) {
  const Catalogue known = readings();
  EXPECT_THROW(find_method(known, "paper_oracle").make({{"families", std::string("spiral")}}),
               OptionError);
}

TEST(Oracle, RowsOfTablesAreMarked) {
  Record plain;
  plain.cell.edit().method = "dm";
  plain.cell.edit().sequence = "room";
  plain.kind.edit().metric = "ate";
  plain.kind.edit().times = "dense";
  Record leaky = plain;
  leaky.cell.edit().method = "paper_oracle";
  leaky.cell.edit().oracle = true;
  const std::vector<Table> tables = pivot({plain, leaky}, {});
  ASSERT_EQ(tables.size(), 1u);
  ASSERT_EQ(tables[0].lines.size(), 2u);
  EXPECT_EQ(tables[0].lines[0][0].text, "dm");
  EXPECT_EQ(tables[0].lines[1][0].text, "paper_oracle (oracle)");
  EXPECT_EQ(note_texts(tables[0]),
            std::vector<std::string>{"oracle: the method uses the reference"});
}

TEST(Oracle, TheStoreKeepsTheFlag) {
  const TemporaryFolder folder;
  Sweep sweep;
  sweep.datasets = {{"parabola", {"simulated", {}}}};
  sweep.methods = {{"leaky", {{"paper_oracle", {}}}}};
  sweep.metrics = {{"ate", {"ate", {}}}};
  const auto file = folder.path() / "results.sqlite";
  {
    const Catalogue known = readings();
    CellKeys keys(sweep, known, {}, "build");
    Store store(file, keys, {}, true);
    store.write(run_cell({}, sweep, parabola(), known));
  }
  const std::vector<Record> records = read_records(file);
  ASSERT_FALSE(records.empty());
  for (const Record& record : records) EXPECT_TRUE(record.cell->oracle);
}

}  // namespace
}  // namespace loopbench::oracle_test
