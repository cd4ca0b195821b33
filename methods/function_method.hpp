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

/// A smoother or a joint method: returns a curve over the keyframes.
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
class FunctionSmoother final : public Smoother {
 public:
  explicit FunctionSmoother(F function) : function_(std::move(function)) {}
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report&) const override {
    return function_(problem);
  }

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

/// An entry whose stage is the `Base` that `T` wraps around the function.
template <class Base, class T, class F>
MethodEntry function_entry(std::string name, Kind kind, std::string summary, F function) {
  MethodEntry out{std::move(name), kind, std::move(summary), {}, {}};
  out.make = [function](const Params& given) -> Stage {
    with(NoOptions{}, given);  // rejects all options
    return std::unique_ptr<const Base>(std::make_unique<T>(function));
  };
  return out;
}

/// An entry without options: method("mine", "what it computes", [](const Problem& problem) { ...
/// return poses; }). Throw metrics::Undefined from the function if it is not applicable.
template <CorrectingFunction F>
MethodEntry method(std::string name, std::string summary, F function) {
  return function_entry<Corrector, FunctionCorrector<F>>(
      std::move(name), Kind::corrector, std::move(summary), std::move(function));
}
template <EstimatingFunction F>
MethodEntry method(std::string name, std::string summary, F function) {
  return function_entry<Estimator, FunctionMethod<F>>(
      std::move(name), Kind::joint, std::move(summary), std::move(function));
}

/// The same for a smoother: the function returns a curve through or near the keyframes.
template <EstimatingFunction F>
MethodEntry smoother(std::string name, std::string summary, F function) {
  return function_entry<Smoother, FunctionSmoother<F>>(
      std::move(name), Kind::smoother, std::move(summary), std::move(function));
}

}  // namespace loopbench::methods
