#include "harness/answers/tables/benchmark_json.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "harness/answers/tables/growth.hpp"

namespace loopbench::harness {
namespace {

// Keys in the order of Google Benchmark.
using JsonEntry = nlohmann::ordered_json;

JsonEntry entry_of(const std::string& name) { return {{"name", name}, {"run_name", name}}; }

JsonEntry benchmark_of(const CellRow& cell, std::size_t repetitions) {
  JsonEntry out = entry_of(cell.sequence + "/" + cell.method.text());
  out["run_type"] = "iteration";
  out["repetitions"] = repetitions;
  out["repetition_index"] = cell.repeat;
  out["threads"] = 1;
  out["iterations"] = cell.runs;
  if (!has_numbers(cell.status)) {
    out["error_occurred"] = true;
    out["error_message"] = to_text(cell.status) + ": " + cell.why;
  }
  out["real_time"] = 1e6 * cell.seconds;
  out["cpu_time"] = 1e6 * cell.cpu_seconds.value_or(0.0);
  out["time_unit"] = "us";
  if (cell.is_stated()) out["real_time_is_stated"] = true;
  if (cell.cpu_seconds_min) out["cpu_time_min"] = 1e6 * *cell.cpu_seconds_min;
  if (cell.cpu_variation) out["cpu_time_cv"] = *cell.cpu_variation;
  if (cell.peak_memory) out["peak_memory"] = *cell.peak_memory;
  return out;
}

/// The aggregates of a fit; both times have the form of the processor time.
void add_complexity(const Growth& growth, nlohmann::ordered_json& out) {
  const auto cpu = fitted_power(growth.sizes, growth.cpu);
  const auto real = fitted_power(growth.sizes, growth.wall);
  if (!cpu || !real) return;
  const auto add = [&](const char* what, const char* unit) -> JsonEntry& {
    JsonEntry one = entry_of(growth.method + "/" + growth.family);
    one["name"] = one["name"].get<std::string>() + "_" + what;
    one["run_type"] = "aggregate";
    one["aggregate_name"] = what;
    one["aggregate_unit"] = unit;
    out.push_back(std::move(one));
    return out.back();
  };
  JsonEntry& law = add("BigO", "time");
  law["cpu_coefficient"] = 1e3 * cpu->factor;
  law["real_coefficient"] = 1e3 * real->factor;
  if (growth.is_stated) law["real_time_is_stated"] = true;
  law["big_o"] = fmt::format("N^{:.2f}", cpu->exponent);
  law["time_unit"] = "us";
  add("RMS", "percentage")["rms"] = cpu->rms;
}

}  // namespace

std::string benchmark_json(const std::vector<CellRow>& cells,
                           const std::map<std::string, std::string>& provenance,
                           const std::vector<std::string>& notes) {
  nlohmann::ordered_json context{{"executable", "loopbench"},
                                 {"num_cpus", sysconf(_SC_NPROCESSORS_ONLN)}};
  for (const auto& [key, value] : provenance) context[key] = value;
  if (!notes.empty()) context["notes"] = notes;
  std::map<std::pair<SharedText, SharedText>, std::size_t> repetitions;
  for (const CellRow& cell : cells) ++repetitions[{cell.sequence, cell.method}];
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const CellRow& cell : cells) {
    all.push_back(benchmark_of(cell, repetitions.at({cell.sequence, cell.method})));
  }
  for (const Growth& growth : growths(cells)) add_complexity(growth, all);
  const nlohmann::ordered_json out{{"context", std::move(context)}, {"benchmarks", std::move(all)}};
  return out.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace loopbench::harness
