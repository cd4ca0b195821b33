/// One replay of a problem by an incremental method, and the order in which its closures arrive.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/core/replay.hpp"
#include "methods/incremental.hpp"
#include "methods/online/extended_chain.hpp"

namespace loopbench::methods {

struct ArrivalOptions {
  double delay = 0.0;
  double jitter = 0.0;
  double repeated = 0.0;
  std::int64_t false_closures = 0;
  std::optional<double> withdrawn_after = 10.0;
  std::int64_t seed = 1;
};

template <class Visit>
void fields(ArrivalOptions& o, Visit visit) {
  visit("delay",
        o.delay,
        "time from the later keyframe of a closure to the arrival of the closure [s]",
        Between{0.0});
  visit("jitter",
        o.jitter,
        "largest random addition to the delay [s]; closures then arrive out of order",
        Between{0.0});
  visit("repeated",
        o.repeated,
        "share of closures that arrive twice and count twice [-]",
        Between{0.0, 1.0});
  visit("false_closures",
        o.false_closures,
        "number of false closures, each between keyframes drawn at random",
        Between{0, 1e6});
  visit("withdrawn_after",
        o.withdrawn_after,
        "time from the arrival of a false closure to its withdrawal [s]; none: it stays",
        Between{0.0});
  visit("seed", o.seed, "seed of delays, repetitions and false closures", Between{0});
}

/// Arrival or withdrawal of a closure.
struct Arrival {
  double time = 0.0;  ///< on the axis of the stamps [s]
  Edge closure;
  bool is_withdrawn = false;
};

/// Returns the arrivals of all closures, sorted by time; at equal times in the order of the
/// problem. A false closure measures what a true one of the problem measures, with its information,
/// between a keyframe and one of the first half before it. A problem without closures or with fewer
/// than three keyframes has none. O(closures log closures).
inline std::vector<Arrival> closure_arrivals(const Problem& problem,
                                             const ArrivalOptions& options) {
  std::mt19937_64 random(static_cast<std::uint64_t>(options.seed));
  // The distributions of the standard library differ between compilers.
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  const auto below = [&](std::size_t count) {
    return static_cast<std::size_t>(uniform() * static_cast<double>(count));
  };
  std::vector<Arrival> out;
  const auto arrive = [&](const Edge& closure, double earliest) {
    out.push_back({earliest + options.delay + options.jitter * uniform(), closure});
    return out.back().time;
  };
  for (const Edge& closure : problem.closures) {
    const double time = arrive(closure, problem.keyframes[closure.to].stamp);
    if (uniform() < options.repeated) arrive(closure, time);
  }
  const std::size_t n = problem.keyframes.size();
  const bool has_room = n >= 3 && !problem.closures.empty();
  for (std::int64_t i = 0; has_room && i < options.false_closures; ++i) {
    Edge closure = problem.closures[below(problem.closures.size())];
    closure.to = 2 + below(n - 2);
    closure.from = below(closure.to / 2);
    const double time = arrive(closure, problem.keyframes[closure.to].stamp);
    if (options.withdrawn_after) out.push_back({time + *options.withdrawn_after, closure, true});
  }
  std::ranges::stable_sort(out, {}, &Arrival::time);
  return out;
}

/// Passes the data to `method`, and records its answers and times.
class ReplayRun {
 public:
  /// All references must outlive this object. `every`: arrivals that start an update.
  ReplayRun(const Problem& problem, Incremental& method, std::size_t every, Report& report)
      : problem_(problem), method_(method), every_(every), report_(report), chain_(problem) {}

  /// Replays the complete problem. `arrivals` are sorted by time.
  void run(std::span<const Arrival> arrivals);

  /// The record; run() comes first.
  Replay take_replay() { return std::move(replay_); }

  /// Poses of all keyframes after the last update.
  const Trajectory& poses() const { return chain_.poses(); }

 private:
  void add_keyframe(std::size_t i);
  void add(const Arrival& arrival);
  void update(double time);

  const Problem& problem_;
  Incremental& method_;
  std::size_t every_;
  Report& report_;
  ExtendedChain chain_;
  Increment waiting_;
  std::size_t edges_ = 0;   ///< odometry edges passed on
  std::size_t frames_ = 0;  ///< frames passed on
  Replay replay_;
};

}  // namespace loopbench::methods
