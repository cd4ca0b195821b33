#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/answers/report/data.hpp"
#include "harness/sweep/model/name_order.hpp"
#include "harness/sweep/store/traces.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kEvenPoints = 400;    // of references: screen resolution
constexpr std::size_t kMostClosures = 200;  // per sequence; more hide the trajectory
constexpr std::size_t kMostSections = 600;  // per cell and kind; more are thinner than a pixel
constexpr double kMostDeviation = 0.2;      // of curves that cannot be thinner

using Column = std::vector<double>;

std::string path_json(const std::vector<TracePose>& poses) {
  return base64(packed_items(thinned(poses, kEvenPoints), kFineSteps));
}

nlohmann::json closures_json(const SequenceTrace& trace) {
  constexpr int kDigits = 7;
  nlohmann::json closures = nlohmann::json::array();
  for (const std::size_t i : subsampled_indices(trace.closures.size(), kMostClosures)) {
    closures.push_back({rounded_number(trace.closures[i].from_stamp, kDigits),
                        rounded_number(trace.closures[i].to_stamp, kDigits)});
  }
  nlohmann::json out{{"closures", std::move(closures)}, {"all", trace.closures.size()}};
  if (trace.ledger.empty()) return out;
  out["ledger"] = trace.ledger;
  out["keyframes"] = path_json(trace.keyframes);
  return out;
}

/// [{name, unit, v}] of the poses of the trace.
nlohmann::json values_json(const CellTrace& trace) {
  nlohmann::json out = nlohmann::json::array();
  for (const TraceValues& each : trace.values) {
    out.push_back({{"name", each.name},
                   {"unit", each.unit},
                   {"v", base64(packed_items(each.values, kDrawnSteps))}});
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

std::vector<double> trace_bytes(const ReportContent& content) {
  constexpr double kBase64 = 4.0 / 3.0;
  Traces traces(content.store);
  const std::map<std::int64_t, std::size_t> sizes = traces.sizes();
  const std::vector<std::size_t> ranks = ranks_of_repeats(content.shown_cells);
  std::vector<double> out;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    out.resize(std::max(out.size(), ranks[i] + 1), 0.0);
    const auto size = sizes.find(content.shown_cells[i].position);
    if (size != sizes.end()) out[ranks[i]] += kBase64 * static_cast<double>(size->second);
  }
  return out;
}

Thinning thinning_for(const std::vector<double>& repeats, double bytes) {
  Thinning out;
  double sum = repeats.empty() ? 0.0 : repeats.front();
  if (sum > bytes) {
    out.deviation =
        bytes > 0.0 ? std::min(kMostDeviation, out.deviation * sum / bytes) : kMostDeviation;
    return out;
  }
  while (out.repeats < repeats.size() && (sum += repeats[out.repeats]) <= bytes) ++out.repeats;
  return out;
}

nlohmann::json traces_json(const ReportContent& content, const Thinning& thinning) {
  Traces traces(content.store);
  std::map<std::string, nlohmann::json> sequences;  // references, and closures of their repeats
  std::map<std::string, double> origins;            // of time [s]
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
        if (sequence.is_null()) sequence["path"] = path_json(trace->reference);
        sequence["runs"][repeat] = closures_json(*trace);
      }
    }
    std::optional<CellTrace> trace = traces.cell(cell.position);
    if (!trace || trace->samples.empty()) continue;
    if (thinning.deviation > kTraceDeviation) trace = thinned(*trace, thinning.deviation);
    nlohmann::json& drawn = cells[std::to_string(i)];
    drawn = {{"times", to_text(trace->times)},
             {"samples", base64(packed_items(trace->samples, kDrawnSteps))}};
    if (!trace->values.empty()) drawn["values"] = values_json(*trace);
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
  return {{"sequences", std::move(all)}, {"cells", std::move(cells)}};
}

}  // namespace loopbench::harness
