#include "harness/sweep/catalogue/external_methods.hpp"

#include <algorithm>
#include <utility>

#include "harness/sweep/catalogue/command_metric.hpp"
#include "harness/sweep/catalogue/server.hpp"
#include "methods/pipeline.hpp"

namespace loopbench::harness {
methods::MethodEntry command_entry() {
  return {kCommand,
          methods::Kind::corrector,
          "any program; see methods/bring_a_method.md",
          describe(CommandOptions{}),
          [](const Params& given) { return make_command(with(CommandOptions{}, given)); }};
}

bool is_program(const Choice& choice) { return choice.name == kCommand; }

CommandOptions command_options(const Params& options, const Sweep& sweep) {
  auto out = with(CommandOptions{}, options);  // the metric has those of the method but `output`
  if (sweep.config.has_parent_path()) out.folder = sweep.config.parent_path();
  return out;
}

bool uses_programs(const Sweep& sweep) {
  return std::ranges::any_of(sweep.datasets, is_program, &DatasetChoice::dataset) ||
         std::ranges::any_of(sweep.metrics, is_program, &MetricChoice::metric) ||
         std::ranges::any_of(sweep.methods, [](const MethodChoice& method) {
           return std::ranges::any_of(method.stages, is_program);
         });
}

std::unique_ptr<const ScratchFolder> scratch_for_programs(const Sweep& sweep) {
  if (!uses_programs(sweep)) return nullptr;
  remove_left_scratch();
  return std::make_unique<const ScratchFolder>();
}

void prepare_programs(const MethodChoice& choice, const Sweep& sweep) {
  const auto prepare = [&](const Choice& each, bool is_metric) {
    if (!is_program(each)) return;
    const CommandOptions options = command_options(each.options, sweep);
    if (options.serve.empty()) return;
    try {
      prepare_server(is_metric ? as_metric(options) : options);
    } catch (const std::exception&) {  // asking fails for the same reason and reports it
    }
  };
  for (const Choice& stage : choice.stages) prepare(stage, false);
  for (const MetricChoice& metric : sweep.metrics) prepare(metric.metric, true);
}

std::string programs_with_network(const Sweep& sweep) {
  std::string out;
  const auto add = [&](const std::string& kind, const std::string& label, const Choice& choice) {
    const auto found = choice.options.find("network");
    if (!is_program(choice) || found == choice.options.end()) return;
    if (found->second == Param(true)) out += kind + " " + label + "\n";
  };
  for (const DatasetChoice& each : sweep.datasets) add("dataset", each.label, each.dataset);
  for (const MethodChoice& each : sweep.methods) {
    for (const Choice& stage : each.stages) add("method", each.label, stage);
  }
  for (const MetricChoice& each : sweep.metrics) add("metric", each.label, each.metric);
  return out;
}

std::unique_ptr<const methods::Estimator> make_method(const MethodChoice& choice,
                                                      const Catalogue& catalogue,
                                                      const Trajectory& reference,
                                                      const Sweep& sweep) {
  std::unique_ptr<const methods::Corrector> corrector;
  std::unique_ptr<const methods::Smoother> smoother;
  std::unique_ptr<const methods::Estimator> joint;
  std::unique_ptr<const methods::Replayer> replayer;
  for (const Choice& part : choice.stages) {
    const methods::MethodEntry& entry = find_method(catalogue, part.name);
    const auto make = [&]() -> methods::Stage {
      if (entry.make_oracle) return entry.make_oracle(part.options, reference);
      if (is_program(part)) return make_command(command_options(part.options, sweep));
      return entry.make(part.options);
    };
    methods::Stage stage = make();
    const auto take = [&stage](auto& to) {
      using Held = std::remove_reference_t<decltype(to)>;
      if (auto* held = std::get_if<Held>(&stage)) to = std::move(*held);
    };
    take(corrector);
    take(smoother);
    take(joint);
    take(replayer);
  }
  if (joint == nullptr) joint = methods::compose(std::move(corrector), std::move(smoother));
  return replayer == nullptr ? std::move(joint) : replayer->replayed(std::move(joint));
}

}  // namespace loopbench::harness
