#include "harness/article/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "datasets/core/fields.hpp"
#include "harness/article/reported.hpp"

namespace loopbench::harness {
namespace {

const std::string kInput = "closed";
const std::string kBaseline = "ORB_SLAM2";

/// The cells of one sequence and reading on the closed input.
class ClosedCells {
 public:
  ClosedCells(const std::vector<PaperCell>& cells, std::string reading, double tie)
      : cells_(cells), reading_(std::move(reading)), tie_(tie) {}

  const PaperCell* cell(const std::string& sequence, const std::string& variant) const {
    PaperCell like;
    like.sequence = sequence;
    like.input = kInput;
    return find_cell(cells_, like, reading_, variant);
  }

  /// -1 if a is smaller, 0 if they are tied, 1 if a is larger.
  int compare(double a, double b) const {
    if (std::abs(a - b) <= tie_ * std::max(std::abs(a), std::abs(b))) return 0;
    return a < b ? -1 : 1;
  }

  Claim claim(const std::string& sequence, const std::string& text) const {
    return {text,
            fmt::format("{}, {}, {}", sequence, kInput, reading_),
            Verdict::cannot_be_judged,
            "no such run"};
  }

 private:
  const std::vector<PaperCell>& cells_;
  std::string reading_;
  double tie_;
};

const ReportedRow& printed(int table, const std::string& variant) {
  return *std::ranges::find_if(reported_rows(), [&](const ReportedRow& row) {
    return row.table == table && row.variant == variant;
  });
}

const char* word(int sign) { return sign < 0 ? "lowers" : sign > 0 ? "raises" : "does not change"; }

/// "N3 lowers the y ATE": compares each row of ours with ORB_SLAM2's row of the same table.
Claim ordering(const ClosedCells& closed, const ReportedRow& row) {
  const ReportedRow& base = printed(row.table, kBaseline);
  const int printed_order = closed.compare(row.ate, base.ate);
  Claim claim = closed.claim(row.sequence,
                             fmt::format("Table {}: {} {} the {} ATE ({} against {})",
                                         row.table,
                                         row.variant,
                                         word(printed_order),
                                         row.axis,
                                         row.ate,
                                         base.ate));
  const PaperCell* ours = closed.cell(row.sequence, row.variant);
  const PaperCell* raw = closed.cell(row.sequence, kBaseline);
  if (ours == nullptr || raw == nullptr) return claim;
  const auto a = axis_numbers(*ours, row.axis, metrics::Times::keyframes);
  const auto b = axis_numbers(*raw, row.axis, metrics::Times::keyframes);
  const auto a_dense = axis_numbers(*ours, row.axis, metrics::Times::dense);
  const auto b_dense = axis_numbers(*raw, row.axis, metrics::Times::dense);
  if (!a || !b || !a_dense || !b_dense) return claim;
  const int at_keyframes = closed.compare(a->ate, b->ate);
  claim.verdict = at_keyframes == printed_order ? Verdict::holds : Verdict::does_not_hold;
  claim.because =
      fmt::format("{} it: {:.4f} against {:.4f} m at keyframes, {:.4f} against {:.4f} between",
                  word(at_keyframes),
                  a->ate,
                  b->ate,
                  a_dense->ate,
                  b_dense->ate);
  return claim;
}

/// "N = 4 is best": on one axis, between keyframes, where exact variants differ.
Claim best(const ClosedCells& closed,
           const std::string& sequence,
           const std::string& axis,
           const std::string& expected,
           const std::vector<std::string>& variants,
           const std::string& source) {
  Claim claim =
      closed.claim(sequence, fmt::format("{}: {} fits best along {}", source, expected, axis));
  std::string winner;
  double least = 0.0;
  claim.because.clear();
  for (const std::string& variant : variants) {
    const PaperCell* cell = closed.cell(sequence, variant);
    const auto numbers = cell ? axis_numbers(*cell, axis, metrics::Times::dense) : std::nullopt;
    if (!numbers) {
      claim.because = variant + " has no result";
      return claim;
    }
    claim.because += fmt::format("{}{} {:.5f}",
                                 claim.because.empty() ? "ATE [m] between keyframes: " : ", ",
                                 variant,
                                 numbers->ate);
    if (winner.empty() || closed.compare(numbers->ate, least) < 0) {
      least = numbers->ate;
      winner = variant;
    }
  }
  claim.verdict = winner == expected ? Verdict::holds : Verdict::does_not_hold;
  return claim;
}

/// Share of tenths of the time in which ours has the lower rmse.
double better_tenths(const metrics::Evaluation& ours, const metrics::Evaluation& raw) {
  constexpr std::size_t kParts = 10;
  std::array<double, kParts> sum{};
  const std::size_t n = std::min(ours.estimate.size(), raw.estimate.size());
  const auto square = [](const metrics::Evaluation& e, std::size_t i) {
    return (e.estimate[i].world_from_body.translation - e.reference[i].world_from_body.translation)
        .squaredNorm();
  };
  for (std::size_t i = 0; i < n; ++i) {
    sum[i * kParts / n] += square(ours, i) - square(raw, i);
  }
  return static_cast<double>(std::ranges::count_if(sum, [](double s) { return s < 0.0; })) / kParts;
}

void overall(const ClosedCells& closed,
             const std::string& sequence,
             const std::string& variant,
             std::vector<Claim>& out) {
  Claim level =
      closed.claim(sequence, variant + ": the same level as ORB_SLAM2 as a whole (within 5 %)");
  Claim areas = closed.claim(sequence, variant + ": better than ORB_SLAM2 in some areas");
  Claim smooth = closed.claim(sequence, variant + ": smoother than ORB_SLAM2's trajectory");
  const PaperCell* ours = closed.cell(sequence, variant);
  const PaperCell* raw = closed.cell(sequence, kBaseline);
  const auto a = ours ? ate_3d(*ours, metrics::Times::dense) : std::nullopt;
  const auto b = raw ? ate_3d(*raw, metrics::Times::dense) : std::nullopt;
  if (a && b) {
    const double change = 100.0 * (*a / *b - 1.0);
    level.verdict = std::abs(change) <= 5.0 ? Verdict::holds : Verdict::does_not_hold;
    level.because = fmt::format(
        "3-D ATE between keyframes {:.4f} against {:.4f} m ({:+.2f} %)", *a, *b, change);
    const double share = better_tenths(ours->dense, raw->dense);
    areas.verdict = share > 0.0 ? Verdict::holds : Verdict::does_not_hold;
    areas.because = fmt::format("lower rmse in {:.0f} of 10 tenths of the time", 10.0 * share);
    smooth.verdict = closed.compare(ours->roughness, raw->roughness) < 0 ? Verdict::holds
                                                                         : Verdict::does_not_hold;
    smooth.because =
        fmt::format("rms second difference {:.2f} against {:.2f} m/s^2 of the polyline",
                    ours->roughness,
                    raw->roughness);
  }
  for (Claim* claim : {&level, &areas, &smooth}) out.push_back(*claim);
}

}  // namespace

std::vector<Claim> check_claims(const std::vector<PaperCell>& cells,
                                const std::string& reading,
                                double tie) {
  const ClosedCells closed(cells, reading, tie);
  std::vector<Claim> out;
  for (const ReportedRow& row : reported_rows()) {
    if (row.variant != kBaseline) out.push_back(ordering(closed, row));
  }
  const std::vector<std::string> planar{"N3", "N4", "N5"};
  const std::vector<std::string> spatial{"M6", "M7", "M8"};
  out.push_back(best(closed, "fr1_room", "y", "N3", planar, "Table 1 (mean and ATE)"));
  out.push_back(best(closed, "fr1_room", "y", "N4", planar, "Text, fr1_room"));
  out.push_back(best(closed, "fr1_room", "z", "M6", spatial, "Table 2"));
  out.push_back(best(closed, "fr3_office", "y", "N4", planar, "Text, fr3_office"));
  out.push_back(best(closed, "fr3_office", "z", "M6", spatial, "Table 4 (ATE)"));
  out.push_back(best(closed, "fr3_office", "z", "M7", spatial, "Text, fr3_office"));
  for (const char* sequence : {"fr1_room", "fr3_office"}) {
    for (const char* variant : {"N4", "M7"}) overall(closed, sequence, variant, out);
  }
  return out;
}

std::string claim_table(const std::vector<Claim>& claims) {
  std::string out = "| claim | judged on | verdict | because |\n| --- | --- | --- | --- |\n";
  for (const Claim& c : claims) {
    out += fmt::format("| {} | {} | *{}* | {} |\n", c.text, c.where, to_text(c.verdict), c.because);
  }
  return out;
}

}  // namespace loopbench::harness
