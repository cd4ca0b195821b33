#include "harness/answers/compare/observations.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "harness/answers/compare/stated.hpp"
#include "harness/answers/compare/typical.hpp"

namespace loopbench::harness {
namespace {

double coverage(const Record& r) {
  if (r.possible == 0) return 1.0;
  return std::min(r.span, static_cast<double>(r.pairs) / static_cast<double>(r.possible));
}

Observed observed(const Record& r, const std::string& value_name) {
  if (r.has_score() && r.status == Status::ok) {
    const double number = value(r, value_name);
    if (std::isfinite(number)) return {number, false, "", coverage(r)};
    return {std::nullopt, true, "not finite"};
  }
  return {std::nullopt, is_loss(r), r.status == Status::ok ? "not evaluated" : to_text(r.status)};
}

}  // namespace

std::string run_id(const CellRow& cell) {
  return cell.sequence + "\n" + std::to_string(cell.repeat);
}

std::string group_id(const CellRow& cell) {
  return cell.group.empty() ? run_id(cell) : cell.group.text();
}

bool is_loss(const Record& r) { return r.status != Status::ok && r.status != Status::declined; }

ObservationsBuilder::ObservationsBuilder(std::string statistic) : value_(std::move(statistic)) {
  value(Record{}, value_);  // rejects an unknown statistic
}

void ObservationsBuilder::put(Observations& table, const Unscored& one) {
  if (table.values.size() <= one.method) table.values.resize(one.method + 1);
  std::vector<Observed>& of_method = table.values[one.method];
  if (of_method.size() <= one.run) of_method.resize(one.run + 1);
  of_method[one.run] = one.observed;
}

void ObservationsBuilder::add(const Record& r) {
  const CellRow& cell = *r.cell;
  const Unscored one{
      methods_.index(cell.method), run_ids_.index(run_id(cell)), observed(r, value_)};
  if (one.method == parts_.size()) parts_.push_back(cell.parts);
  if (one.run == runs_.size()) {
    runs_.push_back({.name = cell.run_name(),
                     .sequence = cell.sequence,
                     .group = group_id(cell),
                     .recording = cell.recording,
                     .is_of_files = cell.group_kind == GroupKind::files,
                     .content = cell.content,
                     .has_oracle_closures = cell.oracle_closures});
  }
  if (cell.oracle) {
    oracle_runs_.emplace(one.method, one.run);
  } else {
    runs_[one.run].is_fair = true;
  }
  if (!r.has_score()) {
    for (Observations& table : tables_) put(table, one);
    unscored_.push_back(one);
    return;
  }
  const auto [kind, is_new] = kinds_.try_emplace(*r.kind, tables_.size());
  if (is_new) {
    ScoreKind& own = tables_.emplace_back().kind = *r.kind;
    own.better = direction_of(*r.kind, value_);
    own.unit = unit_of(*r.kind, value_);
    for (const Unscored& earlier : unscored_) put(tables_.back(), earlier);
  } else if (kind->first.better != r.kind->better || kind->first.target != r.kind->target) {
    tables_[kind->second].kind.better = metrics::Better::neither;  // none holds for all values
  }
  put(tables_[kind->second], one);
  if (is_stated(r)) tables_[kind->second].stated.insert(cell.method);
}

std::vector<Observations> ObservationsBuilder::build() {
  const std::vector<std::string>& names = methods_.names();
  std::set<std::size_t> oracles;
  for (const auto& [method, run] : oracle_runs_) {
    if (runs_[run].is_fair) oracles.insert(method);
  }
  for (Observations& table : tables_) {
    table.runs = runs_;
    table.values.resize(names.size());
    std::vector<std::vector<Observed>> all = std::exchange(table.values, {});
    for (std::size_t m = 0; m < names.size(); ++m) {
      (oracles.contains(m) ? table.oracles : table.methods).push_back(names[m]);
      table.parts.emplace(names[m], parts_[m]);
      if (oracles.contains(m)) continue;
      all[m].resize(runs_.size());
      table.values.push_back(std::move(all[m]));
    }
  }
  return std::move(tables_);
}

std::vector<Observations> observations(const std::vector<Record>& records,
                                       const std::string& value_name) {
  ObservationsBuilder out(value_name);
  for (const Record& r : records) out.add(r);
  return out.build();
}

std::string sequence_key(const ObservedRun& run) {
  return run.is_of_files ? run.recording : run.sequence;
}

std::vector<std::size_t> group_numbers(const Observations& all,
                                       const std::vector<std::size_t>& runs,
                                       bool by_sequence) {
  NameOrder groups;
  std::vector<std::size_t> out;
  for (const std::size_t run : runs) out.push_back(groups.index(all.runs[run].group));
  if (!by_sequence) return out;
  std::map<std::string, std::size_t> first;  // run of each sequence, whose groups are joined
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::size_t own = out[i];
    const std::size_t other = out[first.emplace(sequence_key(all.runs[runs[i]]), i).first->second];
    if (own != other) std::ranges::replace(out, own, other);
  }
  NameOrder order;
  for (std::size_t& group : out) group = order.index(std::to_string(group));
  return out;
}

std::size_t drop_duplicates(Observations& all) {
  std::map<std::string, std::size_t> first;  // first run of each content
  std::vector<std::size_t> kept;
  for (std::size_t run = 0; run < all.runs.size(); ++run) {
    const std::string& content = all.runs[run].content;
    const auto [found, is_new] = first.emplace(content, run);
    if (content.empty() || is_new) {
      kept.push_back(run);
      continue;
    }
    for (std::size_t m = 0; m < all.values.size(); ++m) {
      Observed& one = all.values[m][found->second];
      const Observed& copy = all.values[m][run];
      const bool has_both = one.value && copy.value;
      if (has_both && !tied(*one.value, *copy.value, kTieShare))
        all.unstable.insert(all.methods[m]);
      if (copy.is_loss || (!one.value && !one.is_loss)) one = copy;
    }
  }
  const std::size_t dropped = all.runs.size() - kept.size();
  std::vector<ObservedRun> runs;
  for (const std::size_t run : kept) runs.push_back(all.runs[run]);
  all.runs = std::move(runs);
  for (std::vector<Observed>& of_method : all.values) {
    std::vector<Observed> values;
    for (const std::size_t run : kept) values.push_back(of_method[run]);
    of_method = std::move(values);
  }
  return dropped;
}

}  // namespace loopbench::harness
