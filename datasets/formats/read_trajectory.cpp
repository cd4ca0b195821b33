#include "datasets/core/fields.hpp"
#include "datasets/formats/chain.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/euroc.hpp"
#include "datasets/formats/g2o.hpp"
#include "datasets/formats/kitti.hpp"
#include "datasets/formats/tum.hpp"

namespace loopbench {
namespace {

Trajectory trajectory_of(const PoseGraph& graph, const std::string& name, double period) {
  std::vector<Pose> composed;
  if (graph.vertices.empty()) composed = chain(graph, name);
  const std::vector<Pose>& poses = graph.vertices.empty() ? composed : graph.vertices;
  Trajectory out;
  out.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    out.push_back({static_cast<double>(graph.ids[i]) * period, poses[i]});
  }
  check(out, name);  // composed poses may overflow; ids above 2^53 may give equal stamps
  return out;
}

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& path, const ReadOptions& options) {
  if (!GreaterThan{0.0}.holds(options.period)) {
    throw OptionError("period", "period = " + to_text(options.period) + ": expected period > 0");
  }
  TextFile file(path);
  const Format format = options.format == Format::automatic ? detect_format(file) : options.format;
  if (options.times && format != Format::kitti) {
    throw file.error(
        0, "has format " + to_text(format) + ", which contains stamps, expected no times file");
  }
  if (format == Format::kitti) return read_kitti(file, options);
  if (format == Format::g2o) return trajectory_of(read_g2o(path), file.name(), options.period);
  Trajectory out = format == Format::euroc ? read_euroc(file, options) : read_tum(file, options);
  if (options.findings) *options.findings = {file.repaired.off_unit, file.repaired.repeated};
  return out;
}

}  // namespace loopbench
