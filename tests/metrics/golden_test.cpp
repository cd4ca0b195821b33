/// Results of evo, TUM's scripts, rpg and KITTI's devkit on the same files: 516 rows of
/// golden.json, and single numbers in values.json, some of public data outside the repository.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "datasets/formats/formats.hpp"
#include "datasets/formats/kitti.hpp"
#include "metrics/errors/ape.hpp"
#include "metrics/errors/ate.hpp"
#include "metrics/errors/printed_motion.hpp"
#include "metrics/errors/rpe.hpp"
#include "metrics/errors/segments.hpp"
#include "metrics/protocols/protocols.hpp"
#include "support.hpp"

namespace loopbench::test::golden_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

fs::path golden(const std::string& name) { return fs::path(LOOPBENCH_TEST_DATA) / "golden" / name; }

const Json& table(const std::string& name) {
  static std::map<std::string, Json> seen;
  Json& out = seen[name];
  if (out.empty()) out = Json::parse(std::ifstream(golden(name)));
  return out;
}

/// Published ground truths have repeated stamps.
const Trajectory& file(const fs::path& name) {
  static std::map<fs::path, Trajectory> seen;
  const auto found = seen.find(name);
  if (found != seen.end()) return found->second;
  const fs::path path = golden("") / name;
  return seen.emplace(name, read_trajectory(path, {.repeats = Repeats::keep_first})).first->second;
}

/// Relative tolerance 1e-9, absolute for values that are zero up to rounding (align origin).
constexpr double kZero = 1e-12;
/// The arccos of a trace near 3 amplifies rounding of 1e-16 to 1e-8 rad: for small relative
/// rotations the original's own rounding dominates. So the tolerance is absolute: 5e-9 [rad or
/// deg].
constexpr double kNearZeroByTrace = 5e-9;

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
  for (const auto& [length, wanted] : row["rel"].items()) {
    const std::string share = " " + shares.at(length) + " ";
    const std::string what = label(row) + " " + length;
    expect_same(named(scores, "translation" + share + "m"), wanted["rel_trans"], what);
    expect_same(named(scores, "translation" + share + "%"), wanted["rel_trans_perc"], what);
    expect_same(
        named(scores, "rotation" + share + "deg"), wanted["rel_rot"], what, kNearZeroByTrace);
    expect_same(named(scores, "yaw" + share + "deg"), wanted["rel_yaw"], what);
    expect_same(named(scores, "gravity" + share + "deg"), wanted["rel_gravity"], what);
  }
}

/// Compares all rows of a tool.
template <class Compare>
std::size_t compared(const std::string& tool, Compare compare) {
  std::size_t count = 0;
  for (const Json& row : table("golden.json")) {
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

TEST(Golden, LeavesNoRowOut) {
  EXPECT_EQ(table("golden.json").size(), 252u + 210u + 12u + 12u + 12u + 18u);
}

/// One number of another tool: values.json, with relative tolerances.
class GoldenValue : public testing::TestWithParam<std::string> {};

fs::path path_of(const std::string& name) {
  if (name[0] != '$') return golden(name);
  const char* data = std::getenv("LOOPBENCH_DATA");
  return data == nullptr ? name : data + name.substr(name.find('/'));
}

Params params(const Json& object) {
  Params out;
  for (const auto& [name, value] : object.items()) {
    out[name] = value.is_string() ? Param(value.get<std::string>()) : Param(value.get<double>());
  }
  return out;
}

double statistic(const Json& row, const Evaluation& evaluation) {
  const std::string name = row["statistic"];
  if (name == "scale") return evaluation.alignment.scale;
  const std::vector<MetricEntry> known = metrics::metrics();
  const auto metric =
      std::ranges::find(known, row["metric"].get<std::string>(), &MetricEntry::name);
  const std::vector<Score> scores = metric->score(evaluation, params(row["options"]));
  const Statistics got = named(scores, row["score"]);
  if (name == "count") return static_cast<double>(got.count);
  return name == "rmse" ? got.rmse : got.mean;
}

/// The matrices of KITTI files with their digits.
PrintedPoses printed(const fs::path& reference, const fs::path& estimate) {
  return {read_kitti_matrices(reference), read_kitti_matrices(estimate)};
}

Evaluation of_files(const fs::path& reference,
                    const fs::path& estimate,
                    const Protocol& rules,
                    const PrintedPoses* digits) {
  Evaluation out = evaluate(file(reference), file(estimate), rules);
  out.context.reference = &file(reference);
  out.context.estimate = &file(estimate);
  out.context.printed = digits;
  return out;
}

TEST_P(GoldenValue, IsReproduced) {
  for (const Json& row : table("values.json")) {
    if (row["files"][1] != GetParam()) continue;
    const fs::path reference = path_of(row["files"][0]), estimate = path_of(row["files"][1]);
    if (!fs::exists(estimate)) GTEST_SKIP() << "not found: " << GetParam();
    const Protocol rules = named_protocol(row["protocol"], params(row["changes"])).rules;
    const bool has_digits = row.value("digits", GetParam().find("kitti") != std::string::npos);
    const PrintedPoses digits = has_digits ? printed(reference, estimate) : PrintedPoses{};
    const Evaluation evaluation =
        of_files(reference, estimate, rules, has_digits ? &digits : nullptr);
    const double wanted = row["value"];
    const double difference = std::abs(statistic(row, evaluation) - wanted) / wanted;
    EXPECT_LE(difference, row["tolerance"].get<double>()) << row;
    // Without the digits of the files, the number differs measurably.
    EXPECT_GE(difference, row.value("least_difference", 0.0)) << row;
  }
}

std::set<std::string> estimates() {
  std::set<std::string> out;
  for (const Json& row : table("values.json")) out.insert(row["files"][1]);
  return out;
}

INSTANTIATE_TEST_SUITE_P(Golden, GoldenValue, testing::ValuesIn(estimates()), [](const auto& at) {
  std::string name = at.param;
  std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0; });
  return name;
});

TEST(EvoOnKitti, OtherPairsThanPoseByPoseHaveNoDigits) {
  const fs::path reference = golden("kitti_gt.txt"), estimate = golden("kitti_est.txt");
  const PrintedPoses digits = printed(reference, estimate);
  const auto uses_digits = [&](const NamedProtocol& protocol) {
    return printed_for_evo(of_files(reference, estimate, protocol.rules, &digits)).has_value();
  };
  EXPECT_TRUE(uses_digits(named_protocol("evo")));
  EXPECT_TRUE(uses_digits(named_protocol("evo", {{"align", std::string("sim3")}})));
  EXPECT_FALSE(uses_digits(named_protocol("evo", {{"offset", 0.1}})));
  EXPECT_FALSE(uses_digits(named_protocol("evo", {{"project", std::string("xy")}})));
  EXPECT_FALSE(uses_digits(named_protocol("loopbench")));
}

}  // namespace
}  // namespace loopbench::test::golden_test
