/// Methods without options from functions.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "methods/method.hpp"

namespace loopbench::methods {

/// Returns one pose per keyframe.
using CorrectingFunction = std::function<Trajectory(const Problem&)>;

/// Returns a curve over the keyframes.
using CurveFunction = std::function<std::unique_ptr<const Curve>(const Problem&)>;

class FunctionCorrector final : public Corrector {
 public:
  explicit FunctionCorrector(CorrectingFunction function) : function_(std::move(function)) {}
  Trajectory correct(const Problem& problem, Report&) const override { return function_(problem); }

 private:
  CorrectingFunction function_;
};

class FunctionSmoother final : public Smoother {
 public:
  explicit FunctionSmoother(CurveFunction function) : function_(std::move(function)) {}
  std::unique_ptr<const Curve> smooth(const Problem& problem, Report&) const override {
    return function_(problem);
  }

 private:
  CurveFunction function_;
};

class FunctionMethod final : public Estimator {
 public:
  explicit FunctionMethod(CurveFunction function) : function_(std::move(function)) {}
  std::unique_ptr<const Curve> estimate(const Problem& problem, Report&) const override {
    return function_(problem);
  }

 private:
  CurveFunction function_;
};

/// An entry whose stage is a `T`, one of the classes above, of the function.
template <class T, class Function>
MethodEntry function_entry(std::string name, Kind kind, std::string summary, Function function) {
  const auto make = [function = std::move(function)](const Params& given) -> Stage {
    with(NoOptions{}, given);  // rejects all options
    return std::make_unique<const T>(function);
  };
  return {std::move(name), kind, std::move(summary), {}, make};
}

/// An entry without options: method("mine", "what it computes", [](const Problem& problem) { ...
/// return poses; }). Throw metrics::Undefined from the function if it is not applicable.
inline MethodEntry method(std::string name, std::string summary, CorrectingFunction correct) {
  return function_entry<FunctionCorrector>(
      std::move(name), Kind::corrector, std::move(summary), std::move(correct));
}

/// The same for a joint method: the function returns a curve over the keyframes.
inline MethodEntry method(std::string name, std::string summary, CurveFunction estimate) {
  return function_entry<FunctionMethod>(
      std::move(name), Kind::joint, std::move(summary), std::move(estimate));
}

/// The same for a smoother: the function returns a curve through or near the keyframes.
inline MethodEntry smoother(std::string name, std::string summary, CurveFunction smooth) {
  return function_entry<FunctionSmoother>(
      std::move(name), Kind::smoother, std::move(summary), std::move(smooth));
}

}  // namespace loopbench::methods
