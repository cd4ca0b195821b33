#include "tests/studies/synthetic_records.hpp"

#include <cmath>

#include "harness/sweep/model/evaluated_run.hpp"
#include "metrics/numerics/median.hpp"
#include "tests/support/compared_sweep.hpp"

namespace loopbench::synthetic {

namespace {

double uniform(std::mt19937_64& bits) {
  return (static_cast<double>(bits() >> 11) + 0.5) * 0x1p-53;
}

double normal(std::mt19937_64& bits) {
  return std::sqrt(-2.0 * std::log(uniform(bits))) * std::cos(6.283185307179586 * uniform(bits));
}

double exponential(std::mt19937_64& bits) { return -std::log(uniform(bits)); }

double laplace(std::mt19937_64& bits) {
  const double size = exponential(bits);
  return uniform(bits) < 0.5 ? size : -size;
}

double student(std::mt19937_64& bits) {
  double squares = 0.0;
  for (int i = 0; i < 3; ++i) squares += std::pow(normal(bits), 2);
  return normal(bits) / std::sqrt(squares / 3.0);
}

double gamma4(std::mt19937_64& bits) {
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) sum += exponential(bits);
  return sum;
}

double lognormal(std::mt19937_64& bits) { return std::exp(normal(bits)); }

double mild_lognormal(std::mt19937_64& bits) { return std::exp(0.5 * normal(bits)); }

double half_ties(std::mt19937_64& bits) {
  const bool is_tie = uniform(bits) < 0.5;
  return is_tie ? 0.0 : 1.0 + 0.6 * normal(bits);
}

Record score(std::size_t method, std::size_t group, std::size_t run, std::size_t sequences) {
  Record out =
      compared_sweep::score("sequence " + std::to_string(group) + "." + std::to_string(run),
                            0,
                            "m" + std::to_string(method),
                            0.0);
  if (sequences > 0) {
    out.cell.edit().sequence = "path " + std::to_string(group % sequences);
    out.cell.edit().repeat = static_cast<std::int64_t>(group / sequences * 1000 + run);
  }
  return out;
}

}  // namespace

std::vector<Shape> shapes() {
  std::vector<Shape> out{{"normal", 0.0, normal},
                         {"uniform", 0.5, uniform},
                         {"laplace", 0.0, laplace},
                         {"student 3", 0.0, student},
                         {"gamma 4", 4.0, gamma4},
                         {"exponential", 1.0, exponential},
                         {"lognormal 0.5", 1.1331484530668263, mild_lognormal},
                         {"lognormal 1", 1.6487212707001282, lognormal},
                         {"half ties", 0.5, half_ties}};
  for (Shape& shape : out) {
    std::mt19937_64 bits(5);
    std::vector<double> means(200'000);
    for (double& mean : means) mean = 0.5 * (shape.draw(bits) + shape.draw(bits));
    shape.typical = metrics::median(means);
  }
  return out;
}

std::vector<Record> records(const Truth& truth, const Shape& shape, std::mt19937_64& bits) {
  std::vector<Record> out;
  const std::size_t methods = truth.effects.size();
  std::vector<double> shared(methods);
  for (std::size_t group = 0; group < truth.groups; ++group) {
    for (double& deviation : shared) deviation = shape.draw(bits) - shape.typical;
    const std::size_t sequence = truth.sequences.empty() ? 0 : group % truth.sequences.size();
    const bool is_hard = truth.hard > 0.0 && uniform(bits) < truth.hard;
    for (std::size_t run = 0; run < truth.runs_in_group; ++run) {
      const double size = std::exp(2.0 * normal(bits));
      const std::size_t begin = out.size();
      for (std::size_t m = 0; m < methods; ++m) {
        const double own = shape.draw(bits) - shape.typical;
        double deviation = truth.shared * shared[m] + (1.0 - truth.shared) * own;
        if (m == 0 && truth.baseline_is_fixed) deviation = 0.0;
        Record r = score(m, group, run, truth.sequences.size());
        if (truth.states_groups && truth.runs_in_group > 1)
          r.cell.edit().group = std::to_string(group);
        if (truth.is_independent)
          set_evaluated_group(r.cell.edit(), std::to_string(r.cell->repeat), r.cell->sequence);
        r.cell.edit().content = r.cell->sequence + " " + std::to_string(r.cell->repeat);
        const double effect =
            truth.effects[m] + (truth.sequences.empty() ? 0.0 : truth.sequences[sequence][m]);
        const double scatter =
            truth.dispersion * (truth.dispersions.empty() ? 1.0 : truth.dispersions[sequence]);
        r.statistics.rmse = size * std::exp(effect + scatter * deviation);
        if (truth.diverges > 0.0 && m + 1 == methods && uniform(bits) < truth.diverges) {
          r.statistics.rmse *= 1e12;
        }
        const bool fails = (!truth.failures.empty() && uniform(bits) < truth.failures[m]) ||
                           (is_hard && m == 1 && uniform(bits) < truth.fails_hard);
        if (fails) {
          r.status = Status::failed;
          r.kind.edit().metric.clear();
        }
        out.push_back(r);
      }
      if (uniform(bits) >= truth.copies) continue;
      for (std::size_t m = 0; m < methods; ++m) {
        Record copy = out[begin + m];
        copy.cell.edit().sequence = copy.cell->sequence + " again";
        out.push_back(copy);
      }
    }
  }
  return out;
}

Observations observations(const Truth& truth, const Shape& shape, std::mt19937_64& bits) {
  Observations out;
  out.kind = *compared_sweep::score("", 0, "", 0.0).kind;
  out.values.resize(truth.effects.size());
  for (std::size_t m = 0; m < truth.effects.size(); ++m)
    out.methods.push_back("m" + std::to_string(m));
  for (std::size_t group = 0; group < truth.groups; ++group) {
    const std::size_t sequences = truth.sequences.size();
    const std::size_t sequence = sequences == 0 ? group : group % sequences;
    const std::string name = std::to_string(group);
    out.runs.push_back({name, std::to_string(sequence), name, "", false, ""});
    for (std::size_t m = 0; m < truth.effects.size(); ++m) {
      const double effect =
          truth.effects[m] + (sequences == 0 ? 0.0 : truth.sequences[sequence][m]);
      const bool is_fixed = m == 0 && truth.baseline_is_fixed;
      const double deviation = is_fixed ? 0.0 : shape.draw(bits) - shape.typical;
      const double scatter =
          truth.dispersion * (truth.dispersions.empty() ? 1.0 : truth.dispersions[sequence]);
      out.values[m].push_back({std::exp(effect + scatter * deviation), false, ""});
      if (!truth.failures.empty() && uniform(bits) < truth.failures[m])
        out.values[m].back() = {std::nullopt, true, "failed"};
    }
  }
  return out;
}

}  // namespace loopbench::synthetic
