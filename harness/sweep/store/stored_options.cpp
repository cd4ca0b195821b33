#include "harness/sweep/store/stored_options.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <unordered_map>

namespace loopbench::harness {
namespace {

using OptionsJson = nlohmann::json;

OptionsJson json_of(const Param& value) {
  const double* const number = std::get_if<double>(&value);
  if (number != nullptr && !std::isfinite(*number)) return to_text(value);  // JSON has none
  return std::visit([](const auto& each) { return OptionsJson(each); }, value);
}

OptionsJson json_of(const std::vector<Choice>& stages) {
  OptionsJson out = OptionsJson::array();
  for (const Choice& stage : stages) {
    OptionsJson options = OptionsJson::object();
    for (const auto& [name, value] : stage.options) options[name] = json_of(value);
    out.push_back({stage.name, std::move(options)});
  }
  return out;
}

Param param_of(const OptionsJson& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number()) return value.get<double>();
  return value.get<std::string>();
}

/// By label.
using StoredStages = std::unordered_map<std::string, Shared<std::vector<Choice>>>;

StoredStages stages_of(const OptionsJson& all) {
  StoredStages out;
  for (const auto& [label, stages] : all.items()) {
    std::vector<Choice> own;
    for (const OptionsJson& stage : stages) {
      Choice& choice = own.emplace_back(Choice{stage.at(0).get<std::string>(), {}});
      for (const auto& [name, value] : stage.at(1).items()) {
        choice.options.emplace(name, param_of(value));
      }
    }
    out.emplace(label, std::move(own));
  }
  return out;
}

}  // namespace

std::string options_json(const CellKeys& keys) {
  OptionsJson out{{"datasets", OptionsJson::object()}, {"methods", OptionsJson::object()}};
  for (const DatasetChoice& each : keys.sweep().datasets) {
    out["datasets"][each.label] = json_of({each.dataset});
  }
  for (const MethodChoice& each : keys.sweep().methods) {
    out["methods"][each.label] = json_of(keys.stages_in_full(each));
  }
  return out.dump(-1, ' ', false, OptionsJson::error_handler_t::replace);
}

void add_options(Database& database, std::vector<StoredCell>& cells) try {
  Statement row = database.prepare("SELECT value FROM run WHERE key = 'options'");
  if (!row.step()) return;
  StoredStages datasets, methods;
  std::istringstream sweeps(row.text());  // a line for each that was merged
  for (std::string line; std::getline(sweeps, line);) {
    const OptionsJson all = OptionsJson::parse(line);
    datasets.merge(stages_of(all.at("datasets")));
    methods.merge(stages_of(all.at("methods")));
  }
  const auto set =
      [](Shared<std::vector<Choice>>& stages, const StoredStages& from, const std::string& label) {
        if (const auto own = from.find(label); own != from.end()) stages = own->second;
      };
  for (StoredCell& cell : cells) {
    set(cell.dataset, datasets, cell.sequence);
    set(cell.stages, methods, cell.method);
  }
} catch (const OptionsJson::exception&) {
  // Damaged: as without a row, which the next `run` writes again.
}

}  // namespace loopbench::harness
