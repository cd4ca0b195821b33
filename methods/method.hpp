/// The three interfaces a method may implement, and the entry that lists it.
///
/// A Corrector moves keyframes with the help of loop closures; a Smoother turns keyframes into a
/// curve and cannot remove drift; a Method does both at once. Corrector and smoother compose
/// (pipeline.hpp). All are const and pure: the same problem gives the same bits, on any thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "datasets/core/curve.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench {

/// Stage 1: poses in, better poses out.
class Corrector {
 public:
  virtual ~Corrector() = default;

  /// The reason this problem is not for this method, or nothing.
  virtual std::optional<std::string> declines(const Problem&) const { return std::nullopt; }

  /// One pose per keyframe, same stamps, same order. Throws std::runtime_error on failure.
  virtual Trajectory correct(const Problem& problem, Report& report) const = 0;
};

/// Stage 2: keyframes in, a curve through or near them out.
class Smoother {
 public:
  virtual ~Smoother() = default;

  virtual std::optional<std::string> declines(const Problem&) const { return std::nullopt; }

  /// A curve over exactly the span of the keyframes. The curve owns what it needs.
  virtual std::unique_ptr<const Curve> smooth(const Problem& problem, Report& report) const = 0;
};

/// Both at once, or something else entirely: a problem in, a curve out.
class Method {
 public:
  virtual ~Method() = default;

  virtual std::optional<std::string> declines(const Problem&) const { return std::nullopt; }

  virtual std::unique_ptr<const Curve> estimate(const Problem& problem, Report& report) const = 0;
};

using Stage = std::variant<std::unique_ptr<const Corrector>,
                           std::unique_ptr<const Smoother>,
                           std::unique_ptr<const Method>>;

enum class Kind { corrector, smoother, method };
inline auto choices(Kind) {
  return std::array{std::pair{"corrector", Kind::corrector},
                    std::pair{"smoother", Kind::smoother},
                    std::pair{"method", Kind::method}};
}

struct MethodEntry {
  std::string name;
  Kind kind = Kind::method;
  std::string summary;
  std::vector<OptionInfo> options;
  std::function<Stage(const Params&)> make;  ///< throws OptionError
};

/// Wraps a `T` constructible from `T::Options` as an entry. Other defaults make a variant.
template <class T>
MethodEntry method(std::string name, std::string summary, typename T::Options defaults) {
  constexpr bool is_corrector = std::derived_from<T, Corrector>;
  constexpr bool is_smoother = std::derived_from<T, Smoother>;
  using Base = std::
      conditional_t<is_corrector, Corrector, std::conditional_t<is_smoother, Smoother, Method>>;
  return {std::move(name),
          is_corrector  ? Kind::corrector
          : is_smoother ? Kind::smoother
                        : Kind::method,
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

/// Every built-in, in the order tables show them.
std::vector<MethodEntry> methods();

}  // namespace loopbench
