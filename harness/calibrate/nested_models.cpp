#include "harness/calibrate/nested_models.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace loopbench::harness {
namespace {

struct Shape {
  const char* method;
  std::vector<methods::Regressor> noise;
  std::vector<methods::Regressor> drift[2];  ///< translation, rotation
};

/// The models of the catalogue's methods; translation drift, which motion_drift omits unless its
/// size is given, is estimated here.
std::vector<Shape> shapes() {
  using enum methods::Regressor;
  return {{"motion_drift_const", {edge}, {}},
          {"motion_drift_time", {time}, {}},
          {"motion_drift_distance", {time, distance}, {}},
          {"motion_drift_rotation", {time, distance, rotation}, {}},
          {"motion_drift_speed", {time, distance, rotation, speed}, {}},
          {"motion_drift", {time, distance, rotation}, {{distance}, {time, distance, rotation}}}};
}

constexpr methods::Component kComponents[] = {methods::Component::translation,
                                              methods::Component::rotation};

std::vector<CalibrationResiduals> redrawn(const std::vector<CalibrationResiduals>& sequences,
                                          std::size_t segment,
                                          std::mt19937_64& random) {
  std::vector<CalibrationResiduals> out;
  for (const CalibrationResiduals& s : sequences) {
    CalibrationResiduals drawn{s.label, s.planar, {}};
    const std::size_t length = std::min(segment, s.edges.size());
    while (drawn.edges.size() < s.edges.size()) {
      const std::size_t begin = random() % (s.edges.size() - length + 1);
      const auto from = s.edges.begin() + static_cast<std::ptrdiff_t>(begin);
      drawn.edges.insert(drawn.edges.end(), from, from + static_cast<std::ptrdiff_t>(length));
    }
    drawn.edges.resize(s.edges.size());
    out.push_back(std::move(drawn));
  }
  return out;
}

}  // namespace

std::vector<NestedModel> fit_nested_models(const std::vector<CalibrationResiduals>& sequences) {
  std::vector<NestedModel> out;
  for (const Shape& shape : shapes()) {
    NestedModel model{shape.method, {}, {}};
    for (const methods::Component component : kComponents) {
      const auto h = static_cast<std::size_t>(component);
      model.rates[h] = fit_rates(component, shape.noise, shape.drift[h], sequences);
      if (sequences.size() < 2) continue;
      double sum = 0.0;
      for (std::size_t left_out = 0; left_out < sequences.size(); ++left_out) {
        std::vector<CalibrationResiduals> others = sequences;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
        sum += log_likelihood(fit_rates(component, shape.noise, shape.drift[h], others),
                              {sequences[left_out]});
      }
      model.held_out[h] = sum / count(component, sequences);
    }
    out.push_back(std::move(model));
  }
  return out;
}

std::vector<std::pair<std::string, double>> options_of(const NestedModel& model) {
  std::vector<std::pair<std::string, double>> out;
  for (const methods::Component component : kComponents) {
    const Rates& rates = model.rates[static_cast<std::size_t>(component)];
    for (std::size_t j = 0; j < rates.noise.size(); ++j) {
      const double value = rates.noise_variance[j];
      out.emplace_back(
          methods::name_of(methods::Term{methods::TermKind::noise, component, rates.noise[j]}),
          value > 1e-20 ? value : 0.0);
    }
    for (std::size_t j = 0; j < rates.drift.size(); ++j) {
      const double value = std::sqrt(rates.drift_variance[j]);
      out.emplace_back(
          methods::name_of(methods::Term{methods::TermKind::drift, component, rates.drift[j]}),
          value > 1e-10 ? value : 0.0);
    }
  }
  return out;
}

std::vector<RateInterval> bootstrap(const NestedModel& model,
                                    const std::vector<CalibrationResiduals>& sequences,
                                    std::size_t segment,
                                    int draws,
                                    std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::vector<double>> values;  // per option
  for (int draw = 0; draw < draws; ++draw) {
    const std::vector<CalibrationResiduals> drawn = redrawn(sequences, segment, random);
    NestedModel again = model;
    for (const methods::Component component : kComponents) {
      Rates& rates = again.rates[static_cast<std::size_t>(component)];
      rates = fit_rates(component, rates.noise, rates.drift, drawn);
    }
    const auto options = options_of(again);
    values.resize(options.size());
    for (std::size_t j = 0; j < options.size(); ++j) values[j].push_back(options[j].second);
  }
  std::vector<RateInterval> out;
  for (std::vector<double>& of : values) {
    std::ranges::sort(of);
    const auto at = [&](double share) {
      return of[static_cast<std::size_t>(share * static_cast<double>(of.size() - 1))];
    };
    out.push_back({at(0.05), at(0.95)});
  }
  return out;
}

double root_mean_square(methods::Component component,
                        const std::vector<CalibrationResiduals>& sequences) {
  double sum = 0.0;
  for (const CalibrationResiduals& s : sequences) {
    for (const EdgeError& edge : s.edges) {
      if (component == methods::Component::translation) {
        sum += edge.error.head(s.planar ? 2 : 3).squaredNorm();
      } else {
        sum += edge.error.tail(s.planar ? 1 : 3).squaredNorm();
      }
    }
  }
  return std::sqrt(sum / count(component, sequences));
}

double correlation(methods::Regressor a,
                   methods::Regressor b,
                   const std::vector<CalibrationResiduals>& sequences) {
  double n = 0.0, sa = 0.0, sb = 0.0, saa = 0.0, sbb = 0.0, sab = 0.0;
  for (const CalibrationResiduals& s : sequences) {
    for (const EdgeError& edge : s.edges) {
      const double x = edge.regressors[static_cast<std::size_t>(a)];
      const double y = edge.regressors[static_cast<std::size_t>(b)];
      n += 1.0;
      sa += x;
      sb += y;
      saa += x * x;
      sbb += y * y;
      sab += x * y;
    }
  }
  return (sab - sa * sb / n) / std::sqrt((saa - sa * sa / n) * (sbb - sb * sb / n));
}

}  // namespace loopbench::harness
