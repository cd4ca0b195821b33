#include <memory>

#include "datasets/core/polyline.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/online/batch_updates.hpp"
#include "methods/solvers/kept_order.hpp"

namespace loopbench::methods {
namespace {

class CorrectedPolyline final : public Estimator {
 public:
  CorrectedPolyline(const PoseGraphOptimizer::Options& options, KeptOrder& order)
      : corrector_(options, &order) {}

  std::string why_declined(const Problem& problem) const override {
    return corrector_.why_declined(problem);
  }
  std::unique_ptr<const Curve> estimate(const Problem& problem, Report& report) const override {
    return std::make_unique<Polyline>(corrector_.correct(problem, report));
  }

 private:
  PoseGraphOptimizer corrector_;
};

class PoseGraphUpdates final : public Incremental {
 public:
  PoseGraphUpdates(const PoseGraphOptimizer::Options& options, bool planar)
      : order_(*options.keep_order), method_(options, order_), updates_(method_, planar, true) {}

  Trajectory update(const Increment& added, Report& report) override {
    Trajectory out = updates_.update(added, report);
    report.count("orders", order_.computed());
    if (updates_.declined() > 0) report.count("updates_declined", updates_.declined());
    return out;
  }

 private:
  KeptOrder order_;
  CorrectedPolyline method_;
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
