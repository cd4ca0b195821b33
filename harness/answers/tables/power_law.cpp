#include "harness/answers/tables/power_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace loopbench::harness {
namespace {

constexpr double kLargestExponent = 4.0;

/// Quantile 0.975 of Student's t: a table, then its expansion, to 1 %.
double student(std::size_t degrees) {
  constexpr double kTable[] = {12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306};
  return degrees <= std::size(kTable) ? kTable[degrees - 1]
                                      : 1.96 + 2.5 / static_cast<double>(degrees);
}

/// A law with a given exponent, and its sum of squared relative errors.
struct FixedExponent {
  PowerLaw law;
  double squares = 0.0;
};

FixedExponent fitted_with(double exponent,
                          const std::vector<double>& sizes,
                          const std::vector<double>& values) {
  // 1 = fixed * u + factor * v, with u = 1 / y and v = size^exponent / y.
  double uu = 0.0, uv = 0.0, vv = 0.0, u1 = 0.0, v1 = 0.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double u = 1.0 / values[i];
    const double v = std::pow(sizes[i], exponent) / values[i];
    uu += u * u;
    uv += u * v;
    vv += v * v;
    u1 += u;
    v1 += v;
  }
  const double determinant = uu * vv - uv * uv;
  FixedExponent out;
  out.law.exponent = exponent;
  if (determinant > 1e-12 * uu * vv) {
    out.law.fixed = (u1 * vv - v1 * uv) / determinant;
    out.law.factor = (v1 * uu - u1 * uv) / determinant;
  }
  if (determinant <= 1e-12 * uu * vv || out.law.fixed < 0.0) {
    out.law.fixed = 0.0;
    out.law.factor = v1 / vv;
  }
  if (out.law.factor < 0.0) {
    out.law.factor = 0.0;
    out.law.fixed = u1 / uu;
  }
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double y = out.law.fixed + out.law.factor * std::pow(sizes[i], exponent);
    out.squares += std::pow(y / values[i] - 1.0, 2);
  }
  return out;
}

/// The farthest exponent in one direction with at most this sum of squares.
double farthest(double from,
                double to,
                double squares,
                const std::vector<double>& sizes,
                const std::vector<double>& values) {
  constexpr int kSteps = 400;
  double out = from;
  for (int i = 1; i <= kSteps; ++i) {
    const double exponent = from + (to - from) * i / kSteps;
    if (fitted_with(exponent, sizes, values).squares <= squares) out = exponent;
  }
  return out;
}

}  // namespace

std::optional<PowerLaw> fitted_power(const std::vector<double>& sizes,
                                     const std::vector<double>& values) {
  const std::size_t different = std::set<double>(sizes.begin(), sizes.end()).size();
  if (different < 3) return std::nullopt;
  const auto is_positive = [](double x) { return x > 0.0 && std::isfinite(x); };
  if (!std::ranges::all_of(sizes, is_positive) || !std::ranges::all_of(values, is_positive))
    return std::nullopt;
  const auto squares_with = [&](double exponent) {
    return fitted_with(exponent, sizes, values).squares;
  };
  double best = 0.0;
  for (double exponent = 0.0; exponent <= kLargestExponent; exponent += 0.02) {
    if (squares_with(exponent) < squares_with(best)) best = exponent;
  }
  double low = std::max(0.0, best - 0.02);
  double high = best + 0.02;
  while (high - low > 1e-9) {
    const double a = low + (high - low) / 3.0;
    const double b = high - (high - low) / 3.0;
    if (squares_with(a) < squares_with(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  PowerLaw out = fitted_with(0.5 * (low + high), sizes, values).law;
  double plain = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double y = out.fixed + out.factor * std::pow(sizes[i], out.exponent);
    plain += std::pow(values[i] - y, 2);
    mean += values[i] / static_cast<double>(sizes.size());
  }
  out.rms = std::sqrt(plain / static_cast<double>(sizes.size())) / mean;
  if (different < 4) return out;
  const std::size_t degrees = sizes.size() - 3;
  const double most = squares_with(out.exponent) *
                      (1.0 + std::pow(student(degrees), 2) / static_cast<double>(degrees));
  out.half_width =
      std::max(out.exponent - farthest(out.exponent, 0.0, most, sizes, values),
               farthest(out.exponent, kLargestExponent, most, sizes, values) - out.exponent);
  return out;
}

std::string law_text(const std::optional<PowerLaw>& law) {
  if (!law) return "-";
  if (!law->half_width) return fmt::format("O(n^{:.2f})", law->exponent);
  return fmt::format("O(n^{:.2f} \u00b1 {:.2f})", law->exponent, *law->half_width);
}

}  // namespace loopbench::harness
