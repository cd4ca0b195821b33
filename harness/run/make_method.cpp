#include <utility>

#include "harness/catalogue/external_methods.hpp"
#include "harness/run/run_cell.hpp"
#include "methods/pipeline.hpp"

namespace loopbench::harness {

std::unique_ptr<const methods::Estimator> make_method(const MethodChoice& choice,
                                                      const Catalogue& catalogue,
                                                      const Trajectory& reference,
                                                      const CommandSetting& setting) {
  std::unique_ptr<const methods::Corrector> corrector;
  std::unique_ptr<const methods::Smoother> smoother;
  std::unique_ptr<const methods::Estimator> joint;
  std::unique_ptr<const methods::Replayer> replayer;
  for (const Choice& part : choice.stages) {
    const methods::MethodEntry& entry = find_method(catalogue, part.name);
    methods::Stage stage = entry.make_oracle  ? entry.make_oracle(part.options, reference)
                           : is_program(part) ? make_program(part, setting)
                                              : entry.make(part.options);
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
