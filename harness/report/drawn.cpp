#include <fmt/format.h>

#include <algorithm>

#include "harness/report/data.hpp"
#include "harness/report/packed.hpp"
#include "harness/store/traces.hpp"

namespace loopbench {
namespace {

constexpr std::size_t kMostPointsOfACell = 400;  // of a cell: beyond that a screen shows no more
constexpr std::size_t kFewestPoints = 60;        // below it curves turn into polygons
constexpr std::size_t kMostClosures = 200;       // of a sequence; more hide the trajectory
constexpr double kBytesOfAPoint = 14.0;  // four words of 16 bits in base64, and a share of grids

using Column = std::vector<double>;

struct DrawnPath {
  Column t, x, y, z;
};

std::string json(const DrawnPath& path) {
  return fmt::format("\"t\":{},\"x\":{},\"y\":{},\"z\":{}",
                     packed(path.t),
                     packed(path.x),
                     packed(path.y),
                     packed(path.z));
}

std::string sequence_json(const SequenceTrace& trace, std::size_t most) {
  DrawnPath path;
  for (const std::size_t i : thinned_places(trace.reference.size(), most)) {
    const TracePose& pose = trace.reference[i];
    path.t.push_back(pose.stamp);
    path.x.push_back(pose.x);
    path.y.push_back(pose.y);
    path.z.push_back(pose.z);
  }
  std::string closures;
  for (const std::size_t i : thinned_places(trace.closures.size(), kMostClosures)) {
    closures += fmt::format("{}[{:.7g},{:.7g}]",
                            closures.empty() ? "" : ",",
                            trace.closures[i].from_stamp,
                            trace.closures[i].to_stamp);
  }
  return fmt::format(
      "{{{},\"closures\":[{}],\"all_closures\":{}}}", json(path), closures, trace.closures.size());
}

struct CellErrors {
  DrawnPath reference;  ///< where it was judged
  Column x, y, z, angle;
};

CellErrors errors(const CellTrace& trace, std::size_t most) {
  CellErrors out;
  for (const std::size_t i : thinned_places(trace.samples.size(), most)) {
    const TraceSample& s = trace.samples[i];
    out.reference.t.push_back(s.estimate.stamp);
    out.reference.x.push_back(s.estimate.x - s.error_x);
    out.reference.y.push_back(s.estimate.y - s.error_y);
    out.reference.z.push_back(s.estimate.z - s.error_z);
    out.x.push_back(s.error_x);
    out.y.push_back(s.error_y);
    out.z.push_back(s.error_z);
    out.angle.push_back(s.error_angle);
  }
  return out;
}

/// Cells of the first repeat of their sequence, by place in `cells`.
std::vector<std::size_t> first_repeats(const std::vector<CellRecord>& cells) {
  std::map<std::string, std::int64_t> first;
  for (const CellRecord& cell : cells) {
    const auto [found, is_new] = first.emplace(cell.sequence, cell.repeat);
    if (!is_new) found->second = std::min(found->second, cell.repeat);
  }
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].repeat == first.at(cells[i].sequence)) out.push_back(i);
  }
  return out;
}

}  // namespace

std::size_t points_of_a_cell(std::size_t cells, std::size_t bytes) {
  const double share =
      static_cast<double>(bytes) / static_cast<double>(std::max<std::size_t>(1, cells));
  return std::clamp(
      static_cast<std::size_t>(share / kBytesOfAPoint), kFewestPoints, kMostPointsOfACell);
}

std::string traces_json(const ReportContent& content, std::size_t bytes) {
  Traces traces(content.store);
  const std::vector<std::size_t> drawn = first_repeats(content.cells);
  const std::size_t most = points_of_a_cell(drawn.size(), bytes);
  std::map<std::string, std::string> sequences;
  std::map<std::pair<std::string, Column>, std::size_t> grid_of;  // sequence and stamps
  std::string grids;
  std::string cells;
  for (const std::size_t i : drawn) {
    const CellRecord& cell = content.cells[i];
    if (!sequences.contains(cell.sequence)) {
      const std::optional<SequenceTrace> trace = traces.sequence(cell.position);
      if (trace) sequences.emplace(cell.sequence, sequence_json(*trace, most));
    }
    const std::optional<CellTrace> trace = traces.cell(cell.position);
    if (!trace || trace->samples.empty()) continue;
    const CellErrors e = errors(*trace, most);
    const auto [grid, is_new] =
        grid_of.emplace(std::pair{cell.sequence, e.reference.t}, grid_of.size());
    if (is_new) grids += (grids.empty() ? "{" : ",\n{") + json(e.reference) + "}";
    cells +=
        fmt::format("{}\"{}\":{{\"g\":{},\"times\":\"{}\",\"x\":{},\"y\":{},\"z\":{},\"a\":{}}}",
                    cells.empty() ? "" : ",\n",
                    i,
                    grid->second,
                    to_text(trace->times),
                    packed(e.x),
                    packed(e.y),
                    packed(e.z),
                    packed(e.angle));
  }
  std::string all;
  for (const std::string& name : content.sequences) {
    const auto found = sequences.find(name);
    all += (all.empty() ? "" : ",\n") + (found == sequences.end() ? "null" : found->second);
  }
  return fmt::format("{{\"points\":{},\"sequences\":[{}],\"grids\":[{}],\"cells\":{{{}}}}}",
                     most,
                     all,
                     grids,
                     cells);
}

}  // namespace loopbench
