#include "methods/smoothers/gp/evidence.hpp"

#include "methods/smoothers/parts.hpp"
#include "methods/smoothers/penalised/reinsch.hpp"
#include "methods/smoothers/penalised/unrolled.hpp"

namespace loopbench::methods {
namespace {

double round_to_lattice(double value) {
  return std::pow(10.0, std::round(8.0 * std::log10(value)) / 8.0);
}

struct ScalarNoise {
  double sigma, power;
};

/// Estimates noise and power of translation or rotation from the smoothing spline.
ScalarNoise noise_from_spline(const std::vector<double>& times,
                              const std::vector<Vector3>& y,
                              int P,
                              Criterion criterion) {
  double extent = 1e-3;
  for (const Vector3& value : y) extent = std::max(extent, (value - y.front()).norm());
  const Reinsch reinsch(times);
  // Above this bound the normal equations lose precision.
  const double lambda = std::min(select_lambda(reinsch, times, y, criterion), 1e6);
  const double energy = reinsch.fit(y, lambda).energy.sum();
  const double freedom = 3.0 * static_cast<double>(y.size() - 2);
  const double sigma = round_to_lattice(std::max(std::sqrt(energy / freedom), 1e-9 * extent));
  double power = sigma * sigma / lambda;
  // The jerk power that produces the same acceleration over the smoothing time of the spline.
  if (P == 3) power /= std::max(1.0, std::pow(lambda, 2.0 / 3.0));
  return {sigma, round_to_lattice(power)};
}

}  // namespace

GpParameters initial_parameters(const Trajectory& measured,
                                int P,
                                Criterion criterion,
                                const GpFixedParameters& given) {
  std::vector<double> times = stamps(measured);
  const double first = times.front();
  const double interval = (times.back() - first) / static_cast<double>(times.size() - 1);
  for (double& time : times) time = (time - first) / interval;
  const std::vector<Rotation> rotations = attitudes(measured);
  const UnrolledRotations path(rotations);
  std::vector<Vector3> unrolled;
  for (std::size_t i = 0; i < rotations.size(); ++i)
    unrolled.push_back(path.unroll(i, rotations[i]));
  const ScalarNoise t = noise_from_spline(times, positions_of(measured), P, criterion);
  const ScalarNoise r = noise_from_spline(times, unrolled, P, criterion);
  return {given.sigma_t.value_or(t.sigma),
          given.sigma_r.value_or(r.sigma),
          given.power_t.value_or(t.power),
          given.power_r.value_or(r.power)};
}

template <int P>
GpEstimate estimate_parameters(const GpPosterior<P>& posterior,
                               const typename GpPosterior<P>::States& states,
                               const GpParameters& start,
                               const GpFixedParameters& given) {
  constexpr double kMinDecrease = 1e-3;  // [nats]; a smaller difference may be rounding
  constexpr int kFarthest = 32;          // lattice steps: four decades from the start
  GpEstimate out{start, 1};
  double lowest = posterior.negative_evidence(states, start);
  struct Coordinate {
    double GpParameters::*value;
    bool fixed;
    int moved = 0;
  };
  std::array<Coordinate, 4> coordinates{
      Coordinate{&GpParameters::power_t, given.power_t.has_value()},
      Coordinate{&GpParameters::sigma_t, given.sigma_t.has_value()},
      Coordinate{&GpParameters::power_r, given.power_r.has_value()},
      Coordinate{&GpParameters::sigma_r, given.sigma_r.has_value()}};
  for (int step = 4; step >= 1; step /= 2) {
    for (bool improved = true; improved;) {
      improved = false;
      for (Coordinate& coordinate : coordinates) {
        if (coordinate.fixed) continue;
        for (const int change : {step, -step}) {
          if (std::abs(coordinate.moved + change) > kFarthest) continue;
          GpParameters trial = out.parameters;
          trial.*coordinate.value =
              start.*coordinate.value * std::pow(10.0, (coordinate.moved + change) / 8.0);
          const double value = posterior.negative_evidence(states, trial);
          ++out.evaluations;
          if (!(value < lowest - kMinDecrease)) continue;
          lowest = value;
          out.parameters = trial;
          coordinate.moved += change;
          improved = true;
          break;
        }
      }
    }
  }
  return out;
}

template GpEstimate estimate_parameters<2>(const GpPosterior<2>&,
                                           const GpPosterior<2>::States&,
                                           const GpParameters&,
                                           const GpFixedParameters&);
template GpEstimate estimate_parameters<3>(const GpPosterior<3>&,
                                           const GpPosterior<3>::States&,
                                           const GpParameters&,
                                           const GpFixedParameters&);

}  // namespace loopbench::methods
