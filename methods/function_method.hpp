/// Methods without options from functions.
#pragma once

#include <concepts>
#include <memory>
#include <string>
#include <utility>

#include "methods/method.hpp"

namespace loopbench::methods {

/// A corrector: returns one pose per keyframe.
template <class F>
concept CorrectingFunction = requires(const F& f, const Problem& problem) {
  { f(problem) } -> std::convertible_to<Trajectory>;
};

/// A joint method: returns a curve over the keyframes.
template <class F>
concept EstimatingFunction = requires(const F& f, const Problem& problem) {
  { f(problem) } -> std::convertible_to<std::unique_ptr<const Curve>>;
};

template <CorrectingFunction F>
class FunctionCorrector final : public Corrector {
 public:
  explicit FunctionCorrector(F function) : function_(std::move(function)) {}
  Trajectory correct(const Problem& problem, Report&) const override { return function_(problem); }

 private:
  F function_;
};

template <EstimatingFunction F>
class FunctionMethod final : public Estimator {
 public:
  explicit FunctionMethod(F function) : function_(std::move(function)) {}
  std::unique_ptr<const Curve> estimate(const Problem& problem, Report&) const override {
    return function_(problem);
  }

 private:
  F function_;
};

/// An entry without options: method("mine", "what it computes", [](const Problem& problem) { ...
/// return poses; }). Throw metrics::Undefined from the function if it is not applicable.
template <class F>
requires CorrectingFunction<F> || EstimatingFunction<F> MethodEntry method(std::string name,
                                                                           std::string summary,
                                                                           F function) {
  MethodEntry out;
  out.name = std::move(name);
  out.kind = CorrectingFunction<F> ? Kind::corrector : Kind::joint;
  out.summary = std::move(summary);
  out.make = [function](const Params& given) -> Stage {
    with(NoOptions{}, given);  // rejects all options
    if constexpr (CorrectingFunction<F>) {
      return std::unique_ptr<const Corrector>(std::make_unique<FunctionCorrector<F>>(function));
    } else {
      return std::unique_ptr<const Estimator>(std::make_unique<FunctionMethod<F>>(function));
    }
  };
  return out;
}

}  // namespace loopbench::methods
