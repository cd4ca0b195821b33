#include <memory>

#include "methods/correctors/pose_graph.hpp"
#include "methods/online/batch_updates.hpp"
#include "methods/pipeline.hpp"
#include "methods/solvers/kept_order.hpp"

namespace loopbench::methods {
namespace {

class PoseGraphUpdates final : public Incremental {
 public:
  PoseGraphUpdates(const PoseGraphOptimizer::Options& options, bool planar)
      : order_(*options.keep_order),
        method_(compose(std::make_unique<PoseGraphOptimizer>(options, &order_), nullptr)),
        updates_(*method_, planar, true) {}

  Trajectory update(const Increment& added, Report& report) override {
    Trajectory out = updates_.update(added, report);
    report.count("orders", order_.computed());
    return out;
  }

 private:
  KeptOrder order_;
  std::unique_ptr<const Estimator> method_;
  BatchUpdates updates_;
};

}  // namespace

std::unique_ptr<Incremental> PoseGraphOptimizer::incremental(bool planar) const {
  if (!options_.keep_order) return nullptr;
  Options from_last = options_;
  from_last.start = Start::keyframes;
  return std::make_unique<PoseGraphUpdates>(from_last, planar);
}

}  // namespace loopbench::methods
