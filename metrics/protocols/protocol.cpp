#include "metrics/protocols/protocol.hpp"

#include <charconv>
#include <cmath>
#include <sstream>

#include "datasets/core/params.hpp"

namespace loopbench::metrics {
namespace {

Length read(const std::string& option, const std::string& word) {
  Length out;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, out.value);
  const std::string unit(rest, end);
  const bool is_known = unit.empty() || unit == "%" || unit == "m";
  if (error != std::errc{} || !is_known || !std::isfinite(out.value) || out.value < 0.0) {
    throw OptionError(option,
                      option + ": '" + word + "': expected a length in metres or %, as 100 or 20%");
  }
  out.is_share = unit == "%";
  const std::string number(word.data(), rest);
  out.text = out.is_share ? number + "%" : number + " m";
  if (out.is_share) out.value /= 100.0;
  return out;
}

}  // namespace

std::vector<Length> lengths(const std::string& option, const std::string& text) {
  std::vector<Length> out;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    out.push_back(read(option, word));
    if (out.back().value > 0.0) continue;
    throw OptionError(option, option + ": '" + word + "': expected a positive number");
  }
  if (out.empty()) throw OptionError(option, option + ": is empty, expected lengths as 100 20%");
  return out;
}

Length tolerance(const std::string& option, const std::string& text) { return read(option, text); }

namespace {

[[noreturn]] void refuse(const std::string& field,
                         const std::string& value,
                         const std::string& why) {
  throw OptionError(field, field + " = " + value + ": " + why);
}

void check_alignment(const Protocol& p) {
  if (p.planar == Planar::yes && p.align != Align::se3 && p.align != Align::sim3) {
    refuse("planar", "yes", "applies only to alignments se3 and sim3");
  }
  if (p.align_first == 0) return;
  const std::string first = std::to_string(p.align_first);
  const bool is_first_pose = p.align == Align::origin || p.align == Align::posyaw_origin;
  if (p.align == Align::none || is_first_pose) {
    refuse("align_first", first, "applies only to least-squares alignments, not to origin or none");
  }
  const int needed = p.align == Align::posyaw ? 2 : 3;
  if (p.align_first < needed) {
    refuse("align_first", first, "too few pairs for least squares; for one pose use align: origin");
  }
}

void check_segments(const SegmentErrorRule& rule) {
  const std::vector<Length> wanted = lengths("segments.lengths", rule.lengths);
  const Length miss = tolerance("segments.tolerance", rule.tolerance);
  if (rule.end != SegmentEnd::beyond && miss.value == 0.0) {
    refuse("segments.tolerance", rule.tolerance, "expected more than zero");
  }
  for (const Length& length : wanted) {
    const bool exceeds_share = miss.is_share && miss.value >= 1.0;
    const bool is_longer = !miss.is_share && !length.is_share && miss.value >= length.value;
    if (exceeds_share || is_longer) {
      refuse("segments.tolerance", rule.tolerance, "expected less than every length");
    }
  }
  if (rule.end == SegmentEnd::rpg && rule.step != 1) {
    refuse("segments.step", std::to_string(rule.step), "segments.end = rpg requires step 1");
  }
}

void check_max_pairs(const Protocol& p) {
  const std::string count = std::to_string(p.max_pairs);
  if (!uses_complete_files(p.pairs) && p.max_pairs != Protocol{}.max_pairs) {
    refuse("max_pairs", count, "applies only to pairs tum and tum_random");
  }
  if (p.pairs == PairRule::tum_random && p.max_pairs == 0) {
    refuse("max_pairs", count, "pairs tum_random needs a limit above 0; for all pairs use tum");
  }
}

}  // namespace

void check(const Protocol& p) {
  check_alignment(p);
  check_segments(p.segments);
  if (p.association == Association::index && p.offset != 0.0) {
    refuse("offset", to_text(p.offset), "association index ignores stamps");
  }
  if (uses_complete_files(p.pairs)) {
    const std::string rule = "pairs " + to_text(p.pairs);
    if (p.pairs_from != PairsFrom::estimate) {
      refuse("pairs_from", to_text(p.pairs_from), rule + " always use the estimate");
    }
    if (p.project != ProjectionPlane::none) {
      refuse("project", to_text(p.project), rule + " use the unprojected files");
    }
  }
  check_max_pairs(p);
  if (p.segments.precision == Precision::float32) {
    const bool is_devkit = p.segments.end == SegmentEnd::beyond && p.form == ErrorForm::kitti &&
                           p.angle == AngleFormula::trace;
    if (!is_devkit) {
      refuse("segments.precision",
             "float32",
             "requires end beyond, form kitti, angle trace (KITTI devkit)");
    }
  }
}

}  // namespace loopbench::metrics
