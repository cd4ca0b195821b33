#include "harness/sweep/catalogue/external_methods.hpp"

#include <algorithm>
#include <utility>

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
  return uses_programs(sweep) ? std::make_unique<const ScratchFolder>() : nullptr;
}

void prepare_programs(const MethodChoice& choice, const Sweep& sweep) {
  const auto prepare = [&](const Choice& each) {
    if (!is_program(each)) return;
    const CommandOptions options = command_options(each.options, sweep);
    if (options.serve.empty()) return;
    try {
      prepare_server(options);
    } catch (const std::exception&) {  // asking fails for the same reason and reports it
    }
  };
  std::ranges::for_each(choice.stages, prepare);
  std::ranges::for_each(sweep.metrics, prepare, &MetricChoice::metric);
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
