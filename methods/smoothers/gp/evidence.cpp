#include "methods/smoothers/gp/evidence.hpp"

#include "methods/smoothers/parts.hpp"
#include "methods/smoothers/penalised/reinsch.hpp"
#include "methods/smoothers/penalised/unrolled.hpp"

namespace loopbench {
namespace {

double on_lattice(double value) {
  return std::pow(10.0, std::round(8.0 * std::log10(value)) / 8.0);
}

struct Scalar {
  double sigma, power;
};

/// Noise and power of one kind of axis, from the smoothing spline.
Scalar first_of(const std::vector<double>& times,
                const std::vector<Vector3>& y,
                int P,
                Criterion criterion) {
  double extent = 1e-3;
  for (const Vector3& value : y) extent = std::max(extent, (value - y.front()).norm());
  const Reinsch reinsch(times);
  // Beyond, the normal equations run out of digits.
  const double lambda = std::min(chosen_lambda(reinsch, times, y, criterion), 1e6);
  const double energy = reinsch.fit(y, lambda).energy.sum();
  const double freedom = 3.0 * static_cast<double>(y.size() - 2);
  const double sigma = on_lattice(std::max(std::sqrt(energy / freedom), 1e-9 * extent));
  double power = sigma * sigma / lambda;
  // A jerk that makes as much acceleration over the time that the spline smooths over.
  if (P == 3) power /= std::max(1.0, std::pow(lambda, 2.0 / 3.0));
  return {sigma, on_lattice(power)};
}

}  // namespace

GpParameters first_parameters(const Trajectory& measured,
                              int P,
                              Criterion criterion,
                              const GpGiven& given) {
  std::vector<double> times = stamps(measured);
  const double first = times.front();
  const double interval = (times.back() - first) / static_cast<double>(times.size() - 1);
  for (double& time : times) time = (time - first) / interval;
  const std::vector<Rotation> turned = attitudes(measured);
  const Unrolled path(turned);
  std::vector<Vector3> flat;
  for (std::size_t i = 0; i < turned.size(); ++i) flat.push_back(path.flattened(i, turned[i]));
  const Scalar t = first_of(times, places(measured), P, criterion);
  const Scalar r = first_of(times, flat, P, criterion);
  return {given.sigma_t.value_or(t.sigma),
          given.sigma_r.value_or(r.sigma),
          given.power_t.value_or(t.power),
          given.power_r.value_or(r.power)};
}

template <int P>
GpChosen chosen_parameters(const GpPosterior<P>& posterior,
                           const typename GpPosterior<P>::States& states,
                           const GpParameters& start,
                           const GpGiven& given) {
  constexpr double kBetter = 1e-3;  // [nats]; less is rounding or does not matter
  constexpr int kFarthest = 32;     // four decades from the start
  GpChosen out{start, 1};
  double least = posterior.negative_evidence(states, start);
  struct Knob {
    double GpParameters::*value;
    bool fixed;
    int moved = 0;
  };
  std::array<Knob, 4> knobs{Knob{&GpParameters::power_t, given.power_t.has_value()},
                            Knob{&GpParameters::sigma_t, given.sigma_t.has_value()},
                            Knob{&GpParameters::power_r, given.power_r.has_value()},
                            Knob{&GpParameters::sigma_r, given.sigma_r.has_value()}};
  for (int step = 4; step >= 1; step /= 2) {
    for (bool improved = true; improved;) {
      improved = false;
      for (Knob& knob : knobs) {
        if (knob.fixed) continue;
        for (const int way : {step, -step}) {
          if (std::abs(knob.moved + way) > kFarthest) continue;
          GpParameters trial = out.parameters;
          trial.*knob.value = start.*knob.value * std::pow(10.0, (knob.moved + way) / 8.0);
          const double value = posterior.negative_evidence(states, trial);
          ++out.evaluations;
          if (!(value < least - kBetter)) continue;
          least = value;
          out.parameters = trial;
          knob.moved += way;
          improved = true;
          break;
        }
      }
    }
  }
  return out;
}

template GpChosen chosen_parameters<2>(const GpPosterior<2>&,
                                       const GpPosterior<2>::States&,
                                       const GpParameters&,
                                       const GpGiven&);
template GpChosen chosen_parameters<3>(const GpPosterior<3>&,
                                       const GpPosterior<3>::States&,
                                       const GpParameters&,
                                       const GpGiven&);

}  // namespace loopbench
