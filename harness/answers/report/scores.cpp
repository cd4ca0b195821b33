#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/answers/compare/stated.hpp"
#include "harness/answers/report/curve.hpp"
#include "harness/answers/report/data.hpp"
#include "harness/answers/tables/growth.hpp"

namespace loopbench::harness {
namespace {

/// In the order of `statistics`: rmse, mean, median, max.
nlohmann::json statistics_json(const metrics::Statistics& s) {
  constexpr int kDigits = 5;
  nlohmann::json out = nlohmann::json::array();
  for (const double value : {s.rmse, s.mean, s.median, s.max}) {
    out.push_back(rounded_number(value, kDigits));
  }
  return out;
}

/// Places of the entries of these kinds by their names.
using Places = std::map<std::string, std::size_t>;

/// [{name, options, members}]: families of entries; a member is its place, then the values.
nlohmann::json families_json(const std::vector<OptionFamily>& families,
                             const Places& places,
                             std::string (*name)(const OptionFamily&)) {
  nlohmann::json out = nlohmann::json::array();
  for (const OptionFamily& family : families) {
    nlohmann::json members = nlohmann::json::array();
    for (const OptionFamily::Member& member : family.members) {
      const auto place = places.find(member.name);
      if (place == places.end()) continue;
      nlohmann::json& entry = members.emplace_back(nlohmann::json::array({place->second}));
      for (const double value : member.values) entry.push_back(value);
    }
    out.push_back({{"name", name(family)}, {"options", family.options}, {"members", members}});
  }
  return out;
}

/// [{family, unit, method, sizes, cpu, memory, cpu_law, memory_law}] as in growth_table().
nlohmann::json growth_json(const ReportContent& content, const Places& methods) {
  nlohmann::json out = nlohmann::json::array();
  for (const Growth& g : growths(content.cells)) {
    out.push_back({{"family", g.family},
                   {"unit", g.unit},
                   {"method", methods.at(g.method)},
                   {"sizes", g.sizes},
                   {"cpu", g.cpu},
                   {"memory", g.memory},
                   {"cpu_law", law_text(fitted_power(g.sizes, g.cpu))},
                   {"memory_law", law_text(fitted_power(g.sizes, g.memory))}});
  }
  return out;
}

}  // namespace

nlohmann::json scores_json(const ReportContent& content) {
  std::map<ScoreKind, std::size_t> index_of_kind;
  nlohmann::json kinds = nlohmann::json::array();
  std::map<std::int64_t, std::map<std::size_t, const Record*>> scores;  // by cell, by kind
  for (const Record& r : content.records) {
    if (!r.has_score() || r.kind->metric == "pairs" || r.kind->metric == "time" ||
        r.status != Status::ok)
      continue;
    const auto [found, is_new] = index_of_kind.try_emplace(*r.kind, kinds.size());
    if (is_new) {
      kinds.push_back({{"label", r.kind->short_name()},
                       {"protocol", r.kind->protocol},
                       {"times", r.kind->times},
                       {"metric", r.kind->metric_label()},
                       {"relation", r.kind->relation},
                       {"axis", r.kind->axis},
                       {"unit", r.kind->unit},
                       {"better", to_text(r.kind->better)}});
    }
    scores[r.cell->position][found->second] = &r;
  }
  Places sequence, method;
  for (const std::string& name : content.shown_sequences()) sequence.emplace(name, sequence.size());
  for (const std::string& name : content.methods) method.emplace(name, method.size());
  std::vector<bool> oracle(content.methods.size(), false), stated = oracle;

  nlohmann::json cells = nlohmann::json::array();
  for (const CellRow& cell : content.shown_cells) {
    const std::size_t m = method.at(cell.method);
    if (cell.oracle) oracle[m] = true;
    if (cell.is_stated()) stated[m] = true;
    nlohmann::json values = nlohmann::json::array();
    const auto& own = scores[cell.position];
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const auto found = own.find(k);
      values.push_back(found == own.end() ? nullptr : statistics_json(found->second->statistics));
    }
    cells.push_back({{"sequence", sequence.at(cell.sequence)},
                     {"method", m},
                     {"repeat", cell.repeat},
                     {"ms", rounded_number(1e3 * cell.seconds, 5)},
                     {"values", std::move(values)}});
  }
  const std::vector<std::string> order = style_order(content);
  nlohmann::json styles = nlohmann::json::array();
  for (const std::string& name : content.methods) {
    const auto index = std::ranges::find(order, name) - order.begin();
    const CurveStyle style = curve_style(static_cast<std::size_t>(index));
    styles.push_back({{"color", style.color}, {"dash", style.dash}});
  }
  nlohmann::json shown = nlohmann::json::array();
  for (const std::string& name : default_methods(content)) {
    if (const auto known = method.find(name); known != method.end()) shown.push_back(known->second);
  }
  return {{"methods", content.methods},
          {"word", words_of(content).one},
          {"styles", std::move(styles)},
          {"default_methods", std::move(shown)},
          {"oracle", oracle},
          {"stated", stated},
          {"stated_note", kStatedNote},
          {"sequences", content.shown_sequences()},
          {"baseline", content.run_value("baseline")},
          {"statistics", {"rmse", "mean", "median", "max"}},
          {"kinds", std::move(kinds)},
          {"sequence_families",
           families_json(sequence_families(content.shown_cells),
                         sequence,
                         [](const OptionFamily& family) { return family.name_with_words(); })},
          {"method_families",
           families_json(method_families(content.cells),
                         method,
                         [](const OptionFamily& family) { return family.name; })},
          {"growth", growth_json(content, method)},
          {"cells", std::move(cells)}};
}

}  // namespace loopbench::harness
