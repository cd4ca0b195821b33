#include "datasets/formats/chain.hpp"

#include "datasets/core/error.hpp"

namespace loopbench {

std::vector<Pose> chain(const PoseGraph& graph, const std::string& name) {
  const std::size_t count = graph.ids.size();
  std::vector<const Edge*> step(count, nullptr);
  for (const Edge& edge : graph.edges) {
    if (edge.from + 1 == edge.to && step[edge.from] == nullptr) step[edge.from] = &edge;
  }
  std::vector<Pose> out(count);
  double scale = 1.0;  // of vertex i relative to the first vertex
  for (std::size_t i = 0; i + 1 < count; ++i) {
    if (step[i] == nullptr) {
      throw InputError(name + ": no edge between vertices " + std::to_string(graph.ids[i]) +
                       " and " + std::to_string(graph.ids[i + 1]) +
                       ", expected one between consecutive vertices of a file without poses");
    }
    Pose move = step[i]->from_from_to;
    move.translation *= scale;
    out[i + 1] = normalized(out[i] * move);
    scale *= step[i]->scale;
  }
  return out;
}

}  // namespace loopbench
