#include "harness/sweep/run/check_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

#include "datasets/core/pose_rule.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

template <class... Values>
[[noreturn]] void reject(fmt::format_string<Values...> text, Values&&... values) {
  throw std::runtime_error(fmt::format(text, std::forward<Values>(values)...));
}

/// `name` returns the name of the text for the message; it is called for invalid texts only.
template <class Name>
void check_text(const std::string& text, std::size_t longest, Name name) {
  if (text.size() > longest) {
    reject("{} has {} bytes, expected at most {}", name(), text.size(), longest);
  }
  const std::size_t bad = first_unprintable(text);
  if (bad == text.size()) return;
  reject("{} has byte 0x{:02x} at position {}, expected UTF-8 without control characters",
         name(),
         static_cast<unsigned char>(text[bad]),
         bad + 1);
}

void check_count(std::size_t count, std::size_t most, const char* what) {
  if (count > most) reject("the method reports {} {}, expected at most {}", count, what, most);
}

/// A quoted name for messages; the name itself may be invalid.
std::string quoted_name(const std::string& name) {
  return "'" + printable(std::string_view(name).substr(0, 40)) + "'";
}

void check_section(const methods::Section& section, std::size_t number) {
  const auto name = [&] {
    return fmt::format("section {} ({})", number, quoted_name(section.kind));
  };
  check_text(section.kind, kLongestName, name);
  check_text(section.what, kLongestName, [&] { return "the text of " + name(); });
  const char* expected = section.end < section.begin ? "an end after its begin" : nullptr;
  if (!std::isfinite(section.begin) || !std::isfinite(section.end)) expected = "finite stamps";
  if (expected == nullptr) return;
  reject("{} is from {} to {} s, expected {}",
         name(),
         to_text(section.begin),
         to_text(section.end),
         expected);
}

}  // namespace

void check_span(const Curve* curve, const Trajectory& keyframes) {
  if (curve == nullptr) reject("the method returned no curve");
  const double start = curve->start();
  const double end = curve->end();
  const auto covers = [&](double time) { return start <= time && time <= end; };
  if (!keyframes.empty() && !(covers(keyframes.front().stamp) && covers(keyframes.back().stamp))) {
    reject("the curve spans {} to {} s, expected the span of the keyframes, {} to {} s",
           to_text(start),
           to_text(end),
           to_text(keyframes.front().stamp),
           to_text(keyframes.back().stamp));
  }
}

void CheckedCurve::sample(std::span<const double> times, std::span<Pose> poses) const {
  constexpr double kNotWritten = std::numeric_limits<double>::quiet_NaN();
  for (Pose& pose : poses) pose.translation.setConstant(kNotWritten);
  curve_.sample(times, poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::string rule = violated_rule(poses[i]);
    if (rule.empty()) continue;
    const std::string error = "the curve at " + to_text(times[i]) + " s: " + rule;
    const std::lock_guard lock(mutex_);
    if (first_error_.empty()) first_error_ = error;
    throw std::runtime_error(error);
  }
}

void CheckedCurve::require_valid_so_far() const {
  const std::lock_guard lock(mutex_);
  if (!first_error_.empty()) throw std::runtime_error(first_error_);
}

void check_covariances(const std::vector<Matrix6>& covariances, std::size_t keyframes) {
  if (covariances.empty()) return;
  if (covariances.size() != keyframes) {
    reject("the method states {} covariances, expected one for each of {} keyframes",
           covariances.size(),
           keyframes);
  }
  for (std::size_t i = 0; i < keyframes; ++i) {
    const Matrix6& each = covariances[i];
    if (each.allFinite() && each.isApprox(each.transpose(), 1e-9)) continue;
    reject("the covariance of keyframe {} is not finite and symmetric", i + 1);
  }
}

void check_rejected(const std::optional<std::vector<std::size_t>>& rejected, std::size_t closures) {
  if (!rejected) return;
  for (std::size_t i = 0; i < rejected->size(); ++i) {
    const std::size_t k = (*rejected)[i];
    if (k < closures && (i == 0 || (*rejected)[i - 1] < k)) continue;
    reject("the method rejects closure {}, expected ascending indices of {} closures", k, closures);
  }
}

void check_report(const methods::Report& report) {
  check_count(report.phases.size(), kMostItems, "phases");
  check_count(report.counts.size(), kMostItems, "counts");
  check_count(report.notes.size(), kMostItems, "notes");
  check_count(report.sections.size(), kMostSections, "sections");
  for (const methods::Phase& phase : report.phases) {
    check_text(phase.name, kLongestName, [&] { return "phase " + quoted_name(phase.name); });
    if (std::isfinite(phase.seconds) && phase.seconds >= 0.0) continue;
    reject("phase '{}' takes {} s, expected a finite time >= 0", phase.name, phase.seconds);
  }
  for (const methods::Count& count : report.counts) {
    check_text(count.name, kLongestName, [&] { return "count " + quoted_name(count.name); });
    if (std::isfinite(count.value)) continue;
    reject("count '{}' is {}, expected a finite number", count.name, count.value);
  }
  for (std::size_t i = 0; i < report.notes.size(); ++i) {
    check_text(report.notes[i], kLongestNote, [&] { return fmt::format("note {}", i + 1); });
  }
  for (std::size_t i = 0; i < report.sections.size(); ++i) check_section(report.sections[i], i + 1);
}

void check_scores(const std::vector<metrics::Score>& scores) {
  if (scores.empty() || scores.size() > kMostItems) {  // without any, its runs would be missing
    reject("the metric returned {} scores, expected 1 to {}", scores.size(), kMostItems);
  }
  std::set<std::tuple<std::string_view, std::string_view, std::string_view>> names;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const auto name = [&] { return fmt::format("score {}: a text", i + 1); };
    const metrics::Score& score = scores[i];
    for (const std::string* text : {&score.relation, &score.axis, &score.unit}) {
      check_text(*text, kLongestName, name);
    }
    check_text(score.why_undefined, kLongestNote, name);
    if (score.statistics.count > kMostErrors) {
      reject("score {} is over {} errors, expected at most {}",
             i + 1,
             score.statistics.count,
             kMostErrors);
    }
    if (!names.emplace(score.relation, score.axis, score.unit).second) {
      reject("two scores are named {}{}",
             quoted_name(score.relation),
             score.axis.empty() ? "" : " with axis " + quoted_name(score.axis));
    }
    const auto directions = metrics::choices(score.better);
    if (std::ranges::none_of(directions, [&](const auto& c) { return c.second == score.better; })) {
      reject("score {} has no direction: better is {}, expected lower, higher, target or neither",
             i + 1,
             static_cast<int>(score.better));
    }
    if (std::isfinite(score.target)) continue;
    reject("score {} has the target {}, expected a finite number", i + 1, score.target);
  }
}

std::string stored_reason(std::string_view text) {
  const std::string_view kept = beginning(text, kLongestNote);
  std::string out(beginning(printable(kept), kLongestNote));
  std::ranges::replace(out, '\n', ' ');
  const std::size_t omitted = text.size() - kept.size();
  return omitted == 0 ? out : out + fmt::format(" ... ({} more bytes)", omitted);
}

}  // namespace loopbench::harness
