#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/answers/report/data.hpp"
#include "harness/sweep/model/name_order.hpp"
#include "harness/sweep/store/traces.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostPointsOfACell = 400;  // per cell: screen resolution
constexpr std::size_t kGoodPoints = 100;         // fewer make curves look like polygons
constexpr std::size_t kLeastPoints = 10;         // minimum for a curve
constexpr std::size_t kMostClosures = 200;       // per sequence; more hide the trajectory
constexpr std::size_t kMostSections = 600;       // per cell and kind; more are thinner than a pixel
constexpr double kBytesOfAPoint = 14.0;  // four 16-bit words in base64, and a share of grids

using Column = std::vector<double>;

struct DrawnPath {
  Column t, x, y, z;

  void add(double stamp, const Vector3& position) {
    t.push_back(stamp);
    x.push_back(position.x());
    y.push_back(position.y());
    z.push_back(position.z());
  }
};

nlohmann::json path_json(const DrawnPath& path) {
  return {
      {"t", packed(path.t)}, {"x", packed(path.x)}, {"y", packed(path.y)}, {"z", packed(path.z)}};
}

nlohmann::json path_json(const std::vector<TracePose>& poses, std::size_t most) {
  DrawnPath drawn;
  for (const std::size_t i : subsampled_indices(poses.size(), most)) {
    drawn.add(poses[i].stamp, {poses[i].x, poses[i].y, poses[i].z});
  }
  return path_json(drawn);
}

nlohmann::json closures_json(const SequenceTrace& trace, std::size_t most) {
  constexpr int kDigits = 7;
  nlohmann::json closures = nlohmann::json::array();
  for (const std::size_t i : subsampled_indices(trace.closures.size(), kMostClosures)) {
    closures.push_back({rounded_number(trace.closures[i].from_stamp, kDigits),
                        rounded_number(trace.closures[i].to_stamp, kDigits)});
  }
  nlohmann::json out{{"closures", std::move(closures)}, {"all", trace.closures.size()}};
  if (trace.ledger.empty()) return out;
  out["ledger"] = trace.ledger;
  out["keyframes"] = path_json(trace.keyframes, most);
  return out;
}

struct CellErrors {
  DrawnPath reference;  ///< at the evaluated poses
  Column x, y, z, angle;
};

CellErrors errors(const CellTrace& trace, std::size_t most) {
  CellErrors out;
  for (const std::size_t i : subsampled_indices(trace.samples.size(), most)) {
    const TraceSample& s = trace.samples[i];
    // In single precision, as it is stored.
    const float x = s.estimate.x - s.error_x, y = s.estimate.y - s.error_y;
    out.reference.add(s.estimate.stamp, {x, y, s.estimate.z - s.error_z});
    out.x.push_back(s.error_x);
    out.y.push_back(s.error_y);
    out.z.push_back(s.error_z);
    out.angle.push_back(s.error_angle);
  }
  return out;
}

/// [{name, unit, v}] of the poses of errors().
nlohmann::json values_json(const CellTrace& trace, std::size_t most) {
  nlohmann::json out = nlohmann::json::array();
  for (const TraceValues& each : trace.values) {
    Column drawn;
    for (const std::size_t i : subsampled_indices(each.values.size(), most)) {
      drawn.push_back(each.values[i]);
    }
    out.push_back({{"name", each.name}, {"unit", each.unit}, {"v", packed(drawn)}});
  }
  return out;
}

/// The sections of one kind.
struct DrawnSections {
  std::size_t all = 0;
  Column begin, end;
  NameOrder names;
  std::vector<std::size_t> choices;

  void add(const methods::Section& section, double origin) {
    ++all;
    if (begin.size() == kMostSections) return;
    begin.push_back(section.begin - origin);
    end.push_back(section.end - origin);
    choices.push_back(names.index(section.what));
  }
};

/// [{kind, all, begin, end, names, choices}], a list of sections for each kind: begin and end
/// relative to `origin` [s], and indices into `names` of the choices.
nlohmann::json sections_json(const std::vector<methods::Section>& sections, double origin) {
  NameOrder kinds;
  std::vector<DrawnSections> drawn;
  for (const methods::Section& section : sections) {
    const std::size_t kind = kinds.index(section.kind);
    drawn.resize(kinds.names().size());
    drawn[kind].add(section, origin);
  }
  nlohmann::json out = nlohmann::json::array();
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    out.push_back({{"kind", kinds.names()[i]},
                   {"all", drawn[i].all},
                   {"begin", packed(drawn[i].begin)},
                   {"end", packed(drawn[i].end)},
                   {"names", drawn[i].names.names()},
                   {"choices", drawn[i].choices}});
  }
  return out;
}

/// For each cell the number of smaller repeats of its sequence. O(n log n).
std::vector<std::size_t> ranks_of_repeats(const std::vector<CellRow>& cells) {
  std::map<std::string, std::map<std::int64_t, std::size_t>, std::less<>> ranks;
  for (const CellRow& cell : cells) ranks[cell.sequence][cell.repeat];
  for (auto& [sequence, own] : ranks) {
    for (std::size_t next = 0; auto& [repeat, rank] : own) rank = next++;
  }
  std::vector<std::size_t> out;
  for (const CellRow& cell : cells)
    out.push_back(ranks.find(cell.sequence.text())->second.at(cell.repeat));
  return out;
}

}  // namespace

Thinning thinning_for(const ReportContent& content, double bytes) {
  Thinning out{0, 1};
  const std::vector<std::size_t> ranks = ranks_of_repeats(content.shown_cells);
  for (const std::size_t rank : ranks) out.repeats = std::max(out.repeats, rank + 1);
  for (;; out.repeats = (out.repeats + 1) / 2) {
    const auto cells =
        std::ranges::count_if(ranks, [&](std::size_t rank) { return rank < out.repeats; });
    const double points =
        bytes / (kBytesOfAPoint * static_cast<double>(std::max<std::ptrdiff_t>(1, cells)));
    out.points = static_cast<std::size_t>(
        std::clamp(points, double{kLeastPoints}, double{kMostPointsOfACell}));
    if (out.points >= kGoodPoints || out.repeats == 1) return out;
  }
}

nlohmann::json traces_json(const ReportContent& content, const Thinning& thinning) {
  Traces traces(content.store);
  std::map<std::string, nlohmann::json> sequences;  // references, and closures of their repeats
  std::map<std::string, double> origins;            // of time [s]
  std::map<std::pair<std::string, Column>, std::size_t> grid_of;  // sequence and stamps
  nlohmann::json grids = nlohmann::json::array();
  nlohmann::json cells = nlohmann::json::object();
  const std::vector<std::size_t> ranks = ranks_of_repeats(content.shown_cells);
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    if (ranks[i] >= thinning.repeats) continue;
    const CellRow& cell = content.shown_cells[i];
    const std::string repeat = std::to_string(cell.repeat);
    nlohmann::json& sequence = sequences[cell.sequence];
    if (sequence.is_null() || !sequence["runs"].contains(repeat)) {
      if (const std::optional<SequenceTrace> trace = traces.sequence(cell.position)) {
        origins[cell.sequence] = trace->origin.stamp;
        if (sequence.is_null()) sequence = path_json(trace->reference, thinning.points);
        sequence["runs"][repeat] = closures_json(*trace, thinning.points);
      }
    }
    const std::optional<CellTrace> trace = traces.cell(cell.position);
    if (!trace || trace->samples.empty()) continue;
    const CellErrors e = errors(*trace, thinning.points);
    const auto [grid, is_new] =
        grid_of.emplace(std::pair{cell.sequence, e.reference.t}, grid_of.size());
    if (is_new) grids.push_back(path_json(e.reference));
    nlohmann::json& drawn = cells[std::to_string(i)];
    drawn = {{"grid", grid->second},
             {"times", to_text(trace->times)},
             {"x", packed(e.x)},
             {"y", packed(e.y)},
             {"z", packed(e.z)},
             {"angle", packed(e.angle)}};
    if (!trace->values.empty()) drawn["values"] = values_json(*trace, thinning.points);
    const std::vector<methods::Section> sections = traces.sections(cell.position);
    const auto origin = origins.find(cell.sequence);
    if (!sections.empty() && origin != origins.end()) {
      drawn["cut"] = sections_json(sections, origin->second);
    }
  }
  nlohmann::json all = nlohmann::json::array();
  for (const std::string& name : content.shown_sequences()) {
    const auto found = sequences.find(name);
    all.push_back(found == sequences.end() ? nullptr : std::move(found->second));
  }
  return {{"sequences", std::move(all)}, {"grids", std::move(grids)}, {"cells", std::move(cells)}};
}

}  // namespace loopbench::harness
