/// Interfaces of correctors, smoothers and joint methods, and the registry entry of a method.
///
/// A Corrector adjusts keyframe poses using loop closures. A Smoother fits a curve to the keyframes
/// and cannot remove drift. An Estimator does both: a joint method, or the composition of a
/// corrector and a smoother (pipeline.hpp). A Replayer runs one of these in the order of time. All
/// functions are const and pure: the same problem gives bit-identical results on any thread.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "datasets/core/curve.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/core/problem.hpp"
#include "methods/incremental.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// What correctors and joint methods have in common.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Returns the reason why the method cannot process this problem; empty if it can.
  virtual std::string why_declined(const Problem&) const { return ""; }

  /// Whether the method uses Problem::anchors, or, like `raw`, is defined without measurements. All
  /// others decline problems with anchors, see reason_to_decline().
  virtual bool accepts_anchors() const { return false; }

  /// Returns the method as one that extends its solution while data arrive; null if it has no such
  /// form: a replay then solves the problem again at every update. `planar` as in Problem.
  virtual std::unique_ptr<Incremental> incremental(bool planar) const {
    static_cast<void>(planar);
    return nullptr;
  }
};

/// Stage 1: corrects the keyframe poses.
class Corrector : public Solver {
 public:
  /// Returns one pose per keyframe, in the same order and with the same stamps. Throws
  /// std::runtime_error on failure.
  virtual Trajectory correct(const Problem& problem, Report& report) const = 0;
};

/// Stage 2: fits a curve through or near the keyframes.
class Smoother {
 public:
  virtual ~Smoother() = default;

  virtual std::string why_declined(const Problem&) const { return ""; }

  /// Returns a curve over exactly the time span of the keyframes. The curve owns its data.
  virtual std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const = 0;
};

/// From a problem to a curve. What derives from it in the catalogue is a joint method.
class Estimator : public Solver {
 public:
  virtual std::unique_ptr<const Curve> estimate(const Problem& problem, Report& report) const = 0;
};

/// Returns the reason why a corrector or estimator cannot process the problem, empty if it can: its
/// own, or anchors that it would ignore.
inline std::string reason_to_decline(const Solver& method, const Problem& problem) {
  if (!problem.anchors.empty() && !method.accepts_anchors()) {
    return "the problem has anchors (" + std::to_string(problem.anchors.size()) +
           "), which the method does not use";
  }
  return method.why_declined(problem);
}

/// A stage in front of a method: passes a problem to it in the order of time.
class Replayer {
 public:
  virtual ~Replayer() = default;

  /// Returns the method with a curve that contains the record of its replay (Curve::replay()).
  virtual std::unique_ptr<const Estimator> replayed(
      std::unique_ptr<const Estimator> method) const = 0;
};

using Stage = std::variant<std::unique_ptr<const Corrector>,
                           std::unique_ptr<const Smoother>,
                           std::unique_ptr<const Estimator>,
                           std::unique_ptr<const Replayer>>;

enum class Kind { corrector, smoother, joint, replay };
inline auto choices(Kind) {
  return std::array{std::pair{"corrector", Kind::corrector},
                    std::pair{"smoother", Kind::smoother},
                    std::pair{"joint", Kind::joint},
                    std::pair{"replay", Kind::replay}};
}

struct MethodEntry {
  std::string name;
  Kind kind = Kind::joint;
  std::string summary;
  std::vector<OptionInfo> options;
  std::function<Stage(const Params&)> make;  ///< throws OptionError
  /// Set for an oracle only: makes the method with access to the reference, to quantify the gain
  /// from such a leak. Only the harness calls it; every row of the method is marked and never
  /// ranked. `make` then returns a method that declines.
  std::function<Stage(const Params&, const Trajectory& reference)> make_oracle = {};
};

/// Wraps a `T` constructible from `T::Options` as an entry. Different `defaults` define a variant.
template <class T>
MethodEntry method(std::string name, std::string summary, typename T::Options defaults) {
  constexpr bool is_corrector = std::derived_from<T, Corrector>;
  constexpr bool is_smoother = std::derived_from<T, Smoother>;
  constexpr bool is_replayer = std::derived_from<T, Replayer>;
  using Method = std::conditional_t<is_replayer, Replayer, Estimator>;
  using Base = std::
      conditional_t<is_corrector, Corrector, std::conditional_t<is_smoother, Smoother, Method>>;
  Kind kind = is_replayer ? Kind::replay : Kind::joint;
  if (is_smoother) kind = Kind::smoother;
  if (is_corrector) kind = Kind::corrector;
  return {std::move(name),
          kind,
          std::move(summary),
          describe(defaults),
          [defaults](const Params& given) -> Stage {
            return std::unique_ptr<const Base>(std::make_unique<T>(with(defaults, given)));
          }};
}

// Not a default argument: a nested Options is incomplete there for both compilers.
template <class T>
MethodEntry method(std::string name, std::string summary) {
  return method<T>(std::move(name), std::move(summary), typename T::Options{});
}

/// Returns all built-in methods in the order in which tables list them.
std::vector<MethodEntry> methods();

/// Returns the built-in method. Throws InputError with all names if no method has this one.
MethodEntry find_method(const std::string& name);

/// Returns the keyframes as moved by the built-in corrector `name`. Throws OptionError, InputError
/// if there is no such corrector or it is not applicable to this problem, and std::runtime_error if
/// it fails.
Trajectory correct(const Problem& problem, const std::string& name, const Params& options = {});

}  // namespace loopbench::methods
