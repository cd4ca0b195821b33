#include "harness/answers/tables/growth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "harness/sweep/model/name_order.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

std::optional<double> number_in(const Param& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  const double* const number = std::get_if<double>(&value);
  return number == nullptr ? std::nullopt : std::optional(*number);
}

/// An entry with its numbers, and what it shares with others of its family.
struct Entered {
  std::string label, name;
  std::vector<std::string> words;  ///< texts of options
  std::vector<std::string> names;  ///< of numbers
  std::vector<double> numbers;
  std::string key;  ///< equal within a family
};

Entered entered(const std::string& label, const std::vector<Choice>& stages) {
  Entered out{label, "", {}, {}, {}, ""};
  for (const Choice& stage : stages) {
    out.name += (out.name.empty() ? "" : " + ") + stage.name;
    out.key += "\n\n" + stage.name;
    for (const auto& [name, value] : stage.options) {
      const auto number = number_in(value);
      out.key += "\n" + name + (number ? "" : "=" + to_text(value));
      if (number) {
        out.names.push_back(name);
        out.numbers.push_back(*number);
      } else {
        out.words.push_back(to_text(value));
      }
    }
  }
  return out;
}

OptionFamily family_of(const std::vector<const Entered*>& all) {
  OptionFamily out;
  out.name = all.front()->name;
  out.words = all.front()->words;
  std::vector<std::size_t> varying;
  for (std::size_t i = 0; i < all.front()->names.size(); ++i) {
    const auto differs = [&](const Entered* e) { return e->numbers[i] != all.front()->numbers[i]; };
    if (std::ranges::none_of(all, differs)) continue;
    varying.push_back(i);
    out.options.push_back(all.front()->names[i]);
  }
  for (const Entered* each : all) {
    OptionFamily::Member& member = out.members.emplace_back();
    member.name = each->label;
    for (const std::size_t i : varying) member.values.push_back(each->numbers[i]);
  }
  return out;
}

/// The finished and timed cells of a sequence and method.
using CellsOf = std::map<std::pair<SharedText, SharedText>, std::vector<const CellRow*>>;

Growth growth_of(const OptionFamily& family,
                 const std::string& method,
                 std::int64_t CellRow::*size,
                 const CellsOf& cells) {
  Growth out{family.name_with_words(),
             size == &CellRow::keyframes ? "keyframes" : "closures",
             method,
             {},
             {},
             {},
             {},
             false};
  std::map<double, std::vector<const CellRow*>> by_size;
  for (const OptionFamily::Member& member : family.members) {
    const auto found = cells.find({member.name, method});
    if (found == cells.end()) continue;
    std::vector<double> sizes;
    for (const CellRow* cell : found->second) sizes.push_back(static_cast<double>(cell->*size));
    auto& own = by_size[metrics::median(sizes)];
    own.insert(own.end(), found->second.begin(), found->second.end());
  }
  for (const auto& [own_size, own] : by_size) {
    std::vector<double> cpu, wall, memory;
    for (const CellRow* cell : own) {
      cpu.push_back(1e3 * *cell->cpu_seconds);
      wall.push_back(1e3 * cell->seconds);
      out.is_stated = out.is_stated || cell->is_stated();
      if (cell->peak_memory) memory.push_back(1e-6 * static_cast<double>(*cell->peak_memory));
    }
    out.sizes.push_back(own_size);
    out.cpu.push_back(metrics::median(cpu));
    out.wall.push_back(metrics::median(wall));
    out.memory.push_back(memory.empty() ? std::nan("") : metrics::median(memory));
  }
  return out;
}

}  // namespace

std::string OptionFamily::name_with_words() const {
  std::string out = name;
  for (const std::string& word : words) out += ", " + word;
  return out;
}

std::vector<OptionFamily> sequence_families(const std::vector<CellRow>& cells) {
  std::vector<LabelledStages> all;
  std::set<SharedText> seen;
  for (const CellRow& cell : cells) {
    if (seen.insert(cell.sequence).second) all.emplace_back(cell.sequence, cell.dataset);
  }
  return option_families(all);
}

std::vector<OptionFamily> method_families(const std::vector<CellRow>& cells) {
  std::vector<LabelledStages> all;
  std::set<SharedText> seen;
  for (const CellRow& cell : cells) {
    if (seen.insert(cell.method).second) all.emplace_back(cell.method, cell.stages);
  }
  return option_families(all);
}

std::vector<OptionFamily> option_families(const std::vector<LabelledStages>& labelled) {
  std::vector<Entered> all;
  for (const auto& [label, stages] : labelled) all.push_back(entered(label, *stages));
  NameOrder keys;
  std::vector<std::vector<const Entered*>> groups;
  for (const Entered& each : all) {
    const std::size_t index = keys.index(each.key);
    groups.resize(keys.names().size());
    groups[index].push_back(&each);
  }
  std::vector<OptionFamily> out;
  for (const auto& group : groups) {
    OptionFamily family = family_of(group);
    if (family.options.size() == 1 || family.options.size() == 2) out.push_back(std::move(family));
  }
  return out;
}

std::vector<Growth> growths(const std::vector<CellRow>& cells) {
  CellsOf timed;
  NameOrder methods;
  for (const CellRow& cell : cells) {
    methods.index(cell.method);
    if (cell.runs > 0 && has_numbers(cell.status) && cell.cpu_seconds)
      timed[{cell.sequence, cell.method}].push_back(&cell);
  }
  std::vector<Growth> out;
  for (const OptionFamily& family : sequence_families(cells)) {
    for (const std::string& method : methods.names()) {
      for (const auto size : {&CellRow::keyframes, &CellRow::closure_count}) {
        Growth growth = growth_of(family, method, size, timed);
        if (growth.sizes.size() < 3 || growth.sizes.back() < 2.0 * growth.sizes.front()) continue;
        out.push_back(std::move(growth));
        break;
      }
    }
  }
  return out;
}

Table growth_table(const std::vector<CellRow>& cells) {
  Table out{
      "growth of the costs with the size n",
      {"method",
       "sequences",
       "n",
       "CPU time",
       "CPU at largest n [ms]",
       "peak memory",
       "memory at largest n [MB]"},
      {},
      {"exponents of n beside a fixed cost, fitted to the medians over the repeats of each size, "
       "with 95 % intervals if there are four sizes or more; the peak memory contains that of "
       "the program"}};
  for (const Growth& each : growths(cells)) {
    out.lines.push_back(
        {each.method,
         each.family,
         fmt::format("{:.0f} to {:.0f} {}", each.sizes.front(), each.sizes.back(), each.unit),
         law_text(fitted_power(each.sizes, each.cpu)),
         fmt::format("{:.4g}", each.cpu.back()),
         law_text(fitted_power(each.sizes, each.memory)),
         fmt::format("{:.4g}", each.memory.back())});
  }
  return out;
}

}  // namespace loopbench::harness
