#include "harness/sweep/run/cell_keys.hpp"

#include "harness/sweep/catalogue/external_methods.hpp"
#include "harness/sweep/catalogue/load_sequence.hpp"
#include "harness/sweep/process/sandbox.hpp"
#include "harness/sweep/run/summarise_sequence.hpp"
#include "harness/sweep/text/hash.hpp"

namespace loopbench::harness {
namespace {

/// "NAME, a=1, b=2".
std::string text_of(const Choice& choice) {
  const std::string options = to_text(choice.options);
  return choice.name + (options.empty() ? "" : ", ") + options;
}

std::string hashed(const Params& params) {
  Fields fields;
  for (const auto& [name, value] : params) fields.add(name).add(to_text(value));
  return fields.hashed();
}

std::string version_of_program(const Choice& program, const Sweep& sweep) {
  return command_version(command_options(program.options, sweep),
                         {sweep.limits.seconds, sweep.limits.memory});
}

std::string of_method(const MethodChoice& choice, const Sweep& sweep, const Catalogue& catalogue) {
  Fields fields;
  for (const Choice& stage : choice.stages) {
    fields.add(stage.name)
        .add(hashed(in_full(find_method(catalogue, stage.name).options, stage.options)))
        .add(plugin_version(catalogue, "method", stage.name));
    if (is_program(stage)) fields.add(version_of_program(stage, sweep));
  }
  return fields.hashed();
}

std::string evaluation_fields(const Sweep& sweep, const Catalogue& catalogue) {
  Fields fields;
  for (const metrics::NamedProtocol& protocol : sweep.protocols) {
    fields.add(protocol.label()).add(protocol.version).add(to_text(echo(protocol.rules)));
  }
  for (const MetricChoice& metric : sweep.metrics) {
    // The rows contain the label, so it is part of the content.
    fields.add(metric.label)
        .add(metric.metric.name)
        .add(hashed(
            in_full(find_metric(catalogue, metric.metric.name).options, metric.metric.options)))
        .add(plugin_version(catalogue, "metric", metric.metric.name));
    if (is_program(metric.metric)) fields.add(version_of_program(metric.metric, sweep));
  }
  if (uses_programs(sweep) && !is_sandboxed()) fields.add("no sandbox");
  if (uses_programs(sweep) && is_sandboxed() && !can_hide_network()) fields.add("open network");
  for (const metrics::Times times : sweep.times) fields.add(to_text(times));
  fields.add(to_text(sweep.min_coverage)).add(std::to_string(sweep.timing));
  if (sweep.precision > 0.0) fields.add(to_text(sweep.precision));
  fields.add(sweep.serial ? "serial" : "").add(sweep.traces ? "traces" : "");
  return fields.hashed();
}

/// All options of the dataset of a cell, with the seed of its repeat. Those of views are left out
/// where they have no effect, so that baselines that do not know them fit.
Params options_of(const Cell& cell, const Sweep& sweep, const Catalogue& catalogue) {
  const DatasetChoice& choice = sweep.datasets[cell.dataset];
  Params out = full_options(choice, find_dataset(catalogue, choice.dataset.name), cell.repeat);
  const auto rule = out.find("closures.rule");
  if (rule != out.end() && rule->second == Param("distance")) {
    std::erase_if(out, [](const auto& option) {
      return option.first == "closures.rule" || option.first.starts_with("closures.view.");
    });
  }
  return out;
}

}  // namespace

CellKeys::CellKeys(const Sweep& sweep, const Catalogue& catalogue, DataRoot root, std::string build)
    : sweep_(sweep),
      catalogue_(catalogue),
      root_(std::move(root)),
      build_(std::move(build)),
      evaluation_(evaluation_fields(sweep, catalogue)) {
  for (const MethodChoice& choice : sweep.methods)
    methods_.push_back(of_method(choice, sweep, catalogue));
}

const std::string& CellKeys::configuration_hash(const Cell& cell) {
  const auto [found, fresh] = asked_.try_emplace({cell.dataset, cell.repeat});
  if (!fresh) return found->second;
  const DatasetChoice& choice = sweep_.datasets[cell.dataset];
  Fields fields;
  fields.add(choice.dataset.name).add(hashed(options_of(cell, sweep_, catalogue_)));
  fields.add(plugin_version(catalogue_, "dataset", choice.dataset.name));
  if (!choice.group.empty()) fields.add(choice.group);  // stored with the sequence
  if (choice.align) fields.add("protocol").add(to_text(*choice.align));
  return found->second = fields.hashed();
}

std::string CellKeys::dataset_text(const Cell& cell) const {
  const DatasetChoice& choice = sweep_.datasets[cell.dataset];
  return choice.dataset.name + ": " + to_text(options_of(cell, sweep_, catalogue_)) +
         (choice.align ? ", protocol.align=" + to_text(*choice.align) : "");
}

std::vector<Choice> CellKeys::stages_in_full(const MethodChoice& method) const {
  std::vector<Choice> out = method.stages;
  for (Choice& stage : out) {
    stage.options = in_full(find_method(catalogue_, stage.name).options, stage.options);
  }
  return out;
}

std::string CellKeys::metric_definitions() const {
  std::string out;
  for (const MetricChoice& metric : sweep_.metrics) {
    const metrics::MetricEntry& entry = find_metric(catalogue_, metric.metric.name);
    const Params options = in_full(entry.options, metric.metric.options);
    out += metric.label + "\t" + text_of({metric.metric.name, options}) + "\n";
  }
  return out;
}

std::string CellKeys::method_definitions() const {
  std::string out;
  for (const MethodChoice& method : sweep_.methods) {
    std::string stages;
    for (const Choice& stage : stages_in_full(method)) {
      stages += (stages.empty() ? "" : "; + ") + text_of(stage);
    }
    out += method.label + "\t" + stages + "\n";
  }
  return out;
}

std::vector<InputFile> CellKeys::current_inputs(const Cell& cell,
                                                std::vector<InputFile> inputs) const {
  const Params options = options_of(cell, sweep_, catalogue_);
  for (InputFile& input : inputs) {
    std::filesystem::path now = input.path;
    const auto named = options.find(input.option);
    const auto* text = named == options.end() ? nullptr : std::get_if<std::string>(&named->second);
    if (text != nullptr) {
      for (const std::filesystem::path& folder : root_.folders) {
        if (!std::filesystem::is_regular_file(folder / *text)) continue;
        now = folder / *text;
        break;
      }
    }
    if (!std::filesystem::exists(now)) continue;
    try {
      input = hashed_inputs({{now, input.option}}).front();
    } catch (const InputError& error) {
      throw InputError(with_place(error.what(), sweep_.datasets[cell.dataset], sweep_));
    }
  }
  return inputs;
}

std::string CellKeys::sequence_key(const Cell& cell, const std::vector<InputFile>& inputs) {
  Fields fields;
  fields.add(build_).add(configuration_hash(cell));
  for (const InputFile& input : inputs) fields.add(input.hash);
  return fields.hashed();
}

std::string CellKeys::key(const Cell& cell, const std::vector<InputFile>& inputs) {
  Fields fields;
  fields.add(build_).add(configuration_hash(cell)).add(methods_[cell.method]).add(evaluation_);
  for (const InputFile& input : inputs) fields.add(input.hash);
  return fields.hashed();
}

}  // namespace loopbench::harness
