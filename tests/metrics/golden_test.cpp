/// Results of evo, TUM's scripts and rpg on the same files: all 516 rows.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "datasets/formats/formats.hpp"
#include "metrics/errors/ape.hpp"
#include "metrics/errors/ate.hpp"
#include "metrics/errors/rpe.hpp"
#include "metrics/errors/segments.hpp"
#include "metrics/protocols/protocols.hpp"
#include "support.hpp"

namespace loopbench::test::golden_test {

using namespace metrics;

namespace {

using Json = nlohmann::json;

std::string golden(const std::string& name) {
  return std::string(LOOPBENCH_TEST_DATA) + "/golden/" + name;
}

const Json& rows() {
  static const Json all = [] {
    std::ifstream file(golden("golden.json"));
    return Json::parse(file);
  }();
  return all;
}

const Trajectory& file(const std::string& name) {
  static std::map<std::string, Trajectory> seen;
  const auto found = seen.find(name);
  return found != seen.end() ? found->second
                             : seen.emplace(name, read_trajectory(golden(name))).first->second;
}

/// Relative tolerance 1e-9, absolute for values that are zero up to rounding (align origin).
constexpr double kZero = 1e-12;
/// The arccos of a trace near 3 amplifies rounding of 1e-16 to 1e-8 rad: for small relative
/// rotations the original's own rounding dominates. So the tolerance is absolute: 1e-9 [rad or
/// deg].
constexpr double kNearZeroByTrace = 1e-9;

void expect_same(double got, double wanted, const std::string& what, double zero = kZero) {
  EXPECT_NEAR(got, wanted, std::max(1e-9 * std::abs(wanted), zero)) << what;
}

void expect_same(const Statistics& got,
                 const Json& wanted,
                 const std::string& what,
                 double zero = kZero) {
  const char* count = wanted.contains("n") ? "n" : "num_samples";
  ASSERT_EQ(got.count, wanted.at(count).get<std::size_t>()) << what;
  expect_same(got.rmse, wanted.at("rmse"), what + " rmse", zero);
  expect_same(got.mean, wanted.at("mean"), what + " mean", zero);
  expect_same(got.median, wanted.at("median"), what + " median", zero);
  expect_same(got.std, wanted.at("std"), what + " std", zero);
  expect_same(got.min, wanted.at("min"), what + " min", zero);
  expect_same(got.max, wanted.at("max"), what + " max", zero);
  if (wanted.contains("sse")) expect_same(got.sse, wanted["sse"], what + " sse", zero);
}

std::string label(Json row) {
  for (const char* numbers : {"stats", "rel", "abs_trans", "abs_rot_deg", "trans", "rot_rad"}) {
    row.erase(numbers);
  }
  return row.dump();
}

Evaluation evaluated(const Json& row, const std::string& name, const Params& changes) {
  return evaluate(file("gt.txt"), file(row["est"]), named_protocol(name, changes).rules);
}

Relation relation(const Json& row) {
  return from_text<Relation>(row["relation"].get<std::string>()).value();
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(c));
  return text;
}

void evo_ape(const Json& row) {
  Params changes{{"max_diff", row["max_diff"].get<double>()}};
  if (row.contains("offset_2")) changes["offset"] = row["offset_2"].get<double>();
  if (row.contains("project")) changes["project"] = lower(row["project"]);
  const bool is_first_100 = row["align"] == "se3_n100";
  changes["align"] = is_first_100 ? "se3" : row["align"].get<std::string>();
  if (is_first_100) changes["align_first"] = std::int64_t{100};
  const Evaluation got = evaluated(row, "evo", changes);
  if (row.contains("scale")) expect_same(got.alignment.scale, row["scale"], label(row));
  const std::vector<Score> scores = ape(got, {relation(row)});
  expect_same(scores.at(0).statistics, row["stats"], label(row));
}

void evo_rpe(const Json& row) {
  const std::map<std::string, DeltaUnit> units{{"frames", DeltaUnit::frames},
                                               {"meters", DeltaUnit::m},
                                               {"degrees", DeltaUnit::deg},
                                               {"radians", DeltaUnit::rad}};
  const bool is_reference = row["from_ref"] == 1;
  const RpeOptions options{
      .delta = row["delta"],
      .unit = units.at(row["unit"]),
      .pairs_from = is_reference ? RpePairsFrom::reference : RpePairsFrom::protocol,
      .pairs = row["all_pairs"] == 1 ? RpePairs::all : RpePairs::protocol,
      .relation = relation(row)};
  const std::vector<Score> scores = rpe(evaluated(row, "evo", {}), options);
  expect_same(scores.at(0).statistics, row["stats"], label(row));
}

void tum_ate(const Json& row) {
  const Protocol rules = named_protocol("tum", {{"offset", row["offset"].get<double>()}}).rules;
  const Trajectory scaled = moved_by(Pose{}, row["scale"], file(row["est"]));  // as with --scale
  const Evaluation got = evaluate(file("gt.txt"), scaled, rules);
  expect_same(find(ate(got, {}), "translation", "3d"), row["stats"], label(row));
}

RpeOptions tum_delta(const Json& row) {
  return {.delta = row["delta"], .unit = row["unit"] == "f" ? DeltaUnit::frames : DeltaUnit::s};
}

void tum_rpe(const Json& row) {
  RpeOptions options = tum_delta(row);
  const Evaluation paired = evaluated(row, "tum", {});
  expect_same(find(rpe(paired, options), "translation", "3d"), row["trans"], label(row));
  options.relation = Relation::rotation_angle_rad;
  const Statistics got = rpe(paired, options).at(0).statistics;
  expect_same(got, row["rot_rad"], label(row), kNearZeroByTrace);
}

void tum_pairs_in_evos_form(const Json& row) {
  const Params form{{"form", std::string("evo")}};
  const std::vector<Score> got = rpe(evaluated(row, "tum", form), tum_delta(row));
  expect_same(find(got, "translation", "3d"), row["trans"], label(row));
}

/// Its alignments over all frames and over the first frame.
void rpg(const Json& row) {
  std::string align = row["align"];
  if (row["n_frames"] == 1) align = align == "se3" ? "origin" : "posyaw_origin";
  const Evaluation got = evaluated(row, "rpg", {{"align", align}});
  expect_same(got.reference_length, row["length"], label(row));
  expect_same(got.alignment.scale, row["scale"], label(row));
  expect_same(find(ate(got, {}), "translation", "3d"), row["abs_trans"], label(row));
  expect_same(find(ate(got, {}), "rotation", "3d"), row["abs_rot_deg"], label(row));

  const std::vector<Score> scores = segments(got, {});
  const std::map<std::string, std::string> shares{
      {"7.39", "10%"}, {"14.79", "20%"}, {"22.18", "30%"}, {"29.58", "40%"}, {"36.98", "50%"}};
  ASSERT_EQ(row["rel"].size(), shares.size());
  const auto numbers = [&](const std::string& name, const std::string& axis, const char* unit) {
    for (const Score& score : scores) {
      if (score.relation == name && score.axis == axis && score.unit == unit) {
        return score.statistics;
      }
    }
    throw std::runtime_error("no score " + name + " " + axis + " " + unit);
  };
  for (const auto& [length, wanted] : row["rel"].items()) {
    const std::string& axis = shares.at(length);
    const std::string what = label(row) + " " + length;
    expect_same(numbers("translation", axis, "m"), wanted["rel_trans"], what);
    expect_same(numbers("translation", axis, "%"), wanted["rel_trans_perc"], what);
    expect_same(numbers("rotation", axis, "deg"), wanted["rel_rot"], what, kNearZeroByTrace);
    expect_same(numbers("yaw", axis, "deg"), wanted["rel_yaw"], what);
    expect_same(numbers("gravity", axis, "deg"), wanted["rel_gravity"], what);
  }
}

/// Compares all rows of a tool.
template <class Compare>
std::size_t compared(const std::string& tool, Compare compare) {
  std::size_t count = 0;
  for (const Json& row : rows()) {
    if (row["tool"] != tool) continue;
    compare(row);
    ++count;
  }
  return count;
}

TEST(Golden, EvoApe) { EXPECT_EQ(compared("evo_ape", evo_ape), 252u); }
TEST(Golden, EvoRpe) { EXPECT_EQ(compared("evo_rpe", evo_rpe), 210u); }
TEST(Golden, TumAte) { EXPECT_EQ(compared("tum_ate", tum_ate), 12u); }
TEST(Golden, TumRpe) { EXPECT_EQ(compared("tum_rpe", tum_rpe), 12u); }
TEST(Golden, TumPairsInEvosForm) {
  EXPECT_EQ(compared("same_pairs_evo_convention", tum_pairs_in_evos_form), 12u);
}
TEST(Golden, Rpg) { EXPECT_EQ(compared("rpg", rpg), 18u); }

TEST(Golden, LeavesNoRowOut) { EXPECT_EQ(rows().size(), 252u + 210u + 12u + 12u + 12u + 18u); }

// The commonly quoted number, written out explicitly.
TEST(Golden, BurstSeparatesTheAssociations) {
  const auto rmse = [](Association rule, double max_diff) {
    const Protocol rules{.association = rule, .max_diff = max_diff, .align = Align::se3};
    const Evaluation got = evaluate(file("gt.txt"), file("est_burst.txt"), rules);
    return find(ate(got, {}), "translation", "3d").rmse;
  };
  EXPECT_NEAR(rmse(Association::evo, 0.01), 0.0406472010353845, 1e-12);
  EXPECT_NEAR(rmse(Association::tum, 0.02), 0.0361229585047602, 1e-12);
}

/// Not from golden.json: the result of a literal copy of evaluate_rpe.py in Python 3.11 with
/// random.seed(0), without --fixed_delta.
TEST(Golden, TumRpeOfRandomPairs) {
  const Params random{{"pairs", std::string("tum_random")}};
  const auto expect = [&](const char* name, std::size_t n, double rmse, double mean, double deg) {
    const Evaluation evaluated =
        evaluate(file("gt.txt"), file(name), named_protocol("tum", random).rules);
    const std::vector<Score> got = rpe(evaluated, {});
    const Statistics translation = find(got, "translation", "3d");
    EXPECT_EQ(translation.count, n) << name;
    expect_same(translation.rmse, rmse, name);
    expect_same(translation.mean, mean, name);
    expect_same(find(got, "rotation", "3d").rmse, deg, name);
  };
  expect("est_drift.txt", 9393, 1.5566026278354204, 1.1909726827963953, 9.716495239575913);
  expect("est_corrected.txt", 9393, 0.10058034889875365, 0.0781356581798225, 0.6351958430506388);
  expect("est_burst.txt", 9408, 0.10196076571413372, 0.07908341199621904, 0.6368885820702946);
}

TEST(Golden, RandomPairsHaveNoDelta) {
  const Params random{{"pairs", std::string("tum_random")}};
  const Evaluation evaluated =
      evaluate(file("gt.txt"), file("est_drift.txt"), named_protocol("tum", random).rules);
  EXPECT_EQ(why<Undefined>([&] { rpe(evaluated, {.delta = 1.0, .unit = DeltaUnit::s}); }),
            "rpe: pairs tum_random ignore delta = 1.0 s; use rpe without delta and unit");
  EXPECT_EQ(rpe(evaluated, {.unit = DeltaUnit::s, .pairs = RpePairs::tum}).front().statistics.count,
            620u);
}

}  // namespace
}  // namespace loopbench::test::golden_test
