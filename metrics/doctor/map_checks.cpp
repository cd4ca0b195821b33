#include "metrics/doctor/map_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/map_pairs.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::metrics {

using namespace map_pairs;

namespace {

constexpr std::size_t kFewestOfPart = 10;  // pairs

/// Moves later parts into the frame of the first.
void join(PartedPairs& parted) {
  const Eigen::Affine3d first = similarity(cut(parted.pairs, parted.parts.front()));
  for (std::size_t k = 1; k < parted.parts.size(); ++k) {
    const RowRange& part = parted.parts[k];
    const Eigen::Affine3d moved = first.inverse() * similarity(cut(parted.pairs, part));
    const double scale = std::cbrt(moved.linear().determinant());
    const Rotation rotation(Matrix3(moved.linear() / scale));
    for (std::size_t i = part.begin; i < part.end; ++i) {
      Pose& pose = parted.pairs.estimate[i].world_from_body;
      pose = {(rotation * pose.rotation).normalized(), moved * pose.translation};
    }
  }
}

/// The pairs without short parts.
PartedPairs without_short(const PartedPairs& all) {
  PartedPairs out;
  for (const RowRange& part : all.parts) {
    if (part.end - part.begin < kFewestOfPart) continue;
    const Paired own = cut(all.pairs, part);
    const std::size_t begin = out.pairs.estimate.size();
    out.pairs.reference.insert(
        out.pairs.reference.end(), own.reference.begin(), own.reference.end());
    out.pairs.estimate.insert(out.pairs.estimate.end(), own.estimate.begin(), own.estimate.end());
    out.parts.push_back({begin, out.pairs.estimate.size()});
  }
  return out;
}

/// Differences of the motions from each pair to the next.
struct MotionExcess {
  std::vector<double> distances, angles;
  double scale = 1.0;  ///< of the estimate, over the reference

  explicit MotionExcess(const Paired& pairs, bool has_rotations) {
    const std::size_t n = pairs.estimate.size(), few = n / 200 + 1;
    std::vector<double> of_reference, of_estimate;
    for (std::size_t i = 0; i + few < n; ++i) {
      of_reference.push_back(displacement(pairs.reference, i, i + few));
      of_estimate.push_back(displacement(pairs.estimate, i, i + few));
    }
    const double usual = median_value(std::move(of_reference));
    if (usual > 0.0) scale = median_value(std::move(of_estimate)) / usual;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const double moved = displacement(pairs.reference, i, i + 1);
      distances.push_back(std::abs(displacement(pairs.estimate, i, i + 1) - scale * moved));
      angles.push_back(has_rotations ? std::abs(angle(pairs.estimate, i, i + 1) -
                                                angle(pairs.reference, i, i + 1))
                                     : 0.0);
    }
  }
};

/// What most differences are below, times twenty.
double jump_limit(std::vector<double> differences) {
  constexpr double kMost = 0.85, kOverUsual = 20.0;
  std::ranges::sort(differences);
  return kOverUsual * percentile(differences, kMost);
}

/// Whether a pose is that of the origin, as of the first pose of a map.
bool is_origin(const Pose& pose) {
  return pose.translation.norm() <= kNoNoise &&
         (!has_rotation(pose) || angle_between(pose.rotation, Rotation::Identity()) <= kNoNoise);
}

/// First pairs of the parts, without the first of all.
std::vector<std::size_t> jumps_of(const Paired& pairs) {
  constexpr double kOfSpread = 0.02, kOverExpected = 3.0, kLeastAngle = 0.1;  // [rad]
  const bool has_rotations = std::min(largest_rotation_angle(pairs.reference),
                                      largest_rotation_angle(pairs.estimate)) > kLeastRotation;
  const MotionExcess excess(pairs, has_rotations);
  const double distance =
      std::max(jump_limit(excess.distances), kOfSpread * excess.scale * spread(pairs.reference));
  const double rotation = std::max(jump_limit(excess.angles), kLeastAngle);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i + 1 < pairs.estimate.size(); ++i) {
    const double expected = excess.scale * displacement(pairs.reference, i, i + 1);
    const bool jumps = excess.distances[i] > std::max(distance, kOverExpected * expected) ||
                       (has_rotations && excess.angles[i] > rotation);
    const bool restarts = is_origin(pose_in(pairs.estimate, i + 1)) &&
                          !are_equal(pose_in(pairs.estimate, i), pose_in(pairs.estimate, i + 1));
    if (jumps || restarts) out.push_back(i + 1);
  }
  return out;
}

std::vector<RowRange> parts_at(const std::vector<std::size_t>& begins, std::size_t size) {
  std::vector<RowRange> out{{0, size}};
  for (const std::size_t begin : begins) {
    out.back().end = begin;
    out.push_back({begin, size});
  }
  return out;
}

}  // namespace

double position_error(const PartedPairs& parted) {
  double squares = 0.0, count = 0.0;
  for (const RowRange& part : parted.parts) {
    const Paired own = cut(parted.pairs, part);
    const auto size = static_cast<double>(own.estimate.size());
    const double error = position_error(own, similarity(own));
    squares += size * error * error;
    count += size;
  }
  return std::sqrt(squares / count);
}

namespace {

/// Position error with as many parts that begin between the jumps: where it is as small, the parts
/// follow drift, not other frames.
double error_of_other_parts(const Paired& pairs, const std::vector<std::size_t>& begins) {
  std::vector<std::size_t> middles;
  for (const RowRange& part : parts_at(begins, pairs.estimate.size()))
    middles.push_back((part.begin + part.end) / 2);
  const PartedPairs other = without_short({pairs, parts_at(middles, pairs.estimate.size())});
  return other.parts.empty() ? 0.0 : position_error(other);
}

}  // namespace

std::optional<InputFinding> join_maps(PartedPairs& parted, const Trajectory& file, double most) {
  constexpr std::size_t kParts = 20;
  constexpr double kMostOfDrift = 0.5;
  const Paired& pairs = parted.pairs;
  if (pairs.estimate.size() < kFewestCommonPoses) return std::nullopt;
  const std::vector<std::size_t> begins = jumps_of(pairs);
  if (begins.empty()) return std::nullopt;
  PartedPairs found = without_short({pairs, parts_at(begins, pairs.estimate.size())});
  if (found.parts.size() < 2 || found.parts.size() > kParts) return std::nullopt;
  const Paired& kept = found.pairs;
  if (2 * kept.estimate.size() < pairs.estimate.size()) return std::nullopt;
  const double was = position_error(kept, similarity(kept)), is = position_error(found);
  if (!(is < most * was)) return std::nullopt;
  bool restarts = false;
  for (std::size_t k = 1; k < found.parts.size(); ++k) {
    restarts |= is_origin(pose_in(kept.estimate, found.parts[k].begin));
  }
  if (!restarts && !(is < kMostOfDrift * error_of_other_parts(pairs, begins))) return std::nullopt;
  std::vector<std::string> places;  // also of the parts that are too short
  std::string breaks;               // options
  for (std::size_t k = 0; k < std::min(begins.size(), kParts); ++k) {
    const std::size_t row = row_at(file, pairs.estimate[begins[k]].stamp);
    if (places.size() < kListed) places.push_back(place(file, row));
    breaks += " --break " + to_text(file[row].stamp);
  }
  if (begins.size() > kListed) places.push_back(fmt::format("{} more", begins.size() - kListed));
  InputFinding out{
      Fault::new_map,
      fmt::format("the estimate {} at {}: position error with an alignment of each part {:.3g} -> "
                  "{:.3g} m",
                  restarts ? "starts again at its origin, as after tracking was lost,"
                           : "jumps into another frame",
                  fmt::join(places, ", "),
                  was,
                  is),
      fmt::format("evaluate its parts, each with its own alignment (eval --parts auto); correct it "
                  "with unknown motion there (correct{})",
                  breaks),
      1.0 - is / was,
      static_cast<double>(found.parts.size())};
  join(found);
  parted = std::move(found);
  return out;
}

std::optional<InputFinding> join_scales(PartedPairs& parted, const Trajectory& file) {
  constexpr std::size_t kBlocks = 24, kFewest = 4;  // of each part
  constexpr double kLeastChange = 0.14, kUnexplained = 0.15, kMostAfter = 0.5, kMoves = 0.2;
  const Paired& pairs = parted.pairs;
  const std::size_t n = pairs.estimate.size();
  if (n < 10 * kBlocks / 2) return std::nullopt;
  const std::size_t step = std::max<std::size_t>(1, n / 200);
  std::vector<double> of_reference(kBlocks), of_estimate(kBlocks);
  for (std::size_t i = 0; i + step < n; i += step) {
    const std::size_t block = i * kBlocks / n;
    of_reference[block] += displacement(pairs.reference, i, i + step);
    of_estimate[block] += displacement(pairs.estimate, i, i + step);
  }
  const double usual = median_value(of_reference);
  std::vector<double> ratios;
  for (std::size_t k = 0; k < kBlocks; ++k) {
    const bool moves = of_reference[k] > kMoves * usual && of_estimate[k] > 0.0;
    if (!moves) return std::nullopt;
    ratios.push_back(std::log(of_estimate[k] / of_reference[k]));
  }
  const auto squares = [&](std::size_t from, std::size_t to) {
    double sum = 0.0, mean_of = 0.0;
    for (std::size_t k = from; k < to; ++k) mean_of += ratios[k] / static_cast<double>(to - from);
    for (std::size_t k = from; k < to; ++k) sum += (ratios[k] - mean_of) * (ratios[k] - mean_of);
    return std::pair{sum, mean_of};
  };
  const double all = squares(0, kBlocks).first;
  std::size_t best = 0;
  double least = all, change = 0.0;
  for (std::size_t k = kFewest; k + kFewest <= kBlocks; ++k) {
    const auto [before, ratio_before] = squares(0, k);
    const auto [after, ratio_after] = squares(k, kBlocks);
    if (before + after >= least) continue;
    least = before + after;
    best = k;
    change = ratio_after - ratio_before;
  }
  if (best == 0 || std::abs(change) < kLeastChange || least > kUnexplained * all)
    return std::nullopt;
  // The step at which the ratio changes, near the border of the blocks.
  const double before = std::exp(squares(0, best).second);
  const double after = before * std::exp(change);
  const std::size_t from = (best - 1) * n / kBlocks, to = std::min(n - 1, (best + 1) * n / kBlocks);
  std::size_t begin = best * n / kBlocks;
  double cost = 0.0, lowest = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    const double moved = displacement(pairs.reference, i, i + 1);
    const double found = displacement(pairs.estimate, i, i + 1);
    cost += std::abs(found - before * moved) - std::abs(found - after * moved);
    if (i > from && cost >= lowest) continue;
    lowest = cost;
    begin = i + 1;
  }
  PartedPairs found{pairs, parts_at({begin}, n)};
  const double was = position_error(pairs, similarity(pairs)), is = position_error(found);
  if (!(is < kMostAfter * was)) return std::nullopt;
  InputFinding out{
      Fault::scale_change,
      fmt::format("the estimate's scale changes by a factor of {:.3g} at {}: position error with "
                  "an alignment of each part {:.3g} -> {:.3g} m",
                  std::exp(change),
                  place(file, row_at(file, pairs.estimate[begin].stamp)),
                  was,
                  is),
      "evaluate its parts, each with its own scale (eval --parts auto --align sim3)",
      1.0 - is / was,
      std::exp(change)};
  join(found);
  parted = std::move(found);
  return out;
}

}  // namespace loopbench::metrics
