#include "harness/report/drawn_methods.hpp"

#include <algorithm>
#include <cmath>

namespace loopbench::harness {

std::vector<std::string> usual_methods(const ReportContent& content) {
  constexpr std::size_t kUsualMethods = 5;   // more lines are hard to distinguish
  constexpr std::size_t kFewestMethods = 2;  // even if their curves coincide
  constexpr double kSame = 0.03;
  std::vector<std::string> out;
  const auto add = [&](const std::string& name) {
    if (out.size() < kUsualMethods && std::ranges::count(out, name) == 0) out.push_back(name);
  };
  if (const Comparison* headline = content.headline()) {
    add(headline->options.baseline);
    std::vector<double> drawn;
    for (const MethodVerdict& m : headline->methods) {
      const bool coincides = std::ranges::any_of(
          drawn, [&](double median) { return std::abs(m.median - median) <= kSame * median; });
      if (coincides) continue;
      drawn.push_back(m.median);
      add(m.method);
    }
    for (const MethodVerdict& m : headline->methods) {
      if (out.size() < kFewestMethods) add(m.method);
    }
    return out;
  }
  for (const std::string& name : content.methods) add(name);
  return out;
}

std::vector<std::string> style_order(const ReportContent& content) {
  std::vector<std::string> out = content.methods;
  const auto baseline = content.run.find("baseline");
  if (baseline == content.run.end()) return out;
  const auto found = std::ranges::find(out, baseline->second);
  if (found != out.end()) std::rotate(out.begin(), found, found + 1);
  return out;
}

}  // namespace loopbench::harness
