#include "harness/store/plan.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostShardsListed = 100'000;
constexpr const char* kMethodLine = "method\t";
constexpr const char* kDatasetLine = "dataset\t";

/// A label on one line without tabs.
std::string one_field(std::string label) {
  std::ranges::replace_if(
      label, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return label;
}

/// "0-3,5": ascending numbers as ranges.
std::string ranges_text(const std::vector<std::size_t>& numbers) {
  std::string out;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i;
    while (end + 1 < numbers.size() && numbers[end + 1] == numbers[end] + 1) ++end;
    out += (out.empty() ? "" : ",") + std::to_string(numbers[i]);
    if (end > i) out += "-" + std::to_string(numbers[end]);
    i = end + 1;
  }
  return out;
}

/// Numbers up to `most` of ranges_text().
std::vector<std::size_t> numbers_of(const std::string& ranges, std::size_t most) {
  std::vector<std::size_t> out;
  std::istringstream in(ranges);
  for (std::string range; std::getline(in, range, ',');) {
    std::istringstream words(range);
    std::size_t begin = 0;
    std::size_t end = 0;
    if (!(words >> begin)) return {};
    end = begin;
    if (words.get() == '-') words >> end;
    for (std::size_t i = begin; i <= std::min(end, most); ++i) out.push_back(i);
  }
  return out;
}

}  // namespace

std::string plan_text(const Sweep& sweep, const std::vector<Cell>& all) {
  std::string out;
  for (const MethodChoice& method : sweep.methods) {
    out += kMethodLine + one_field(method.label) + "\n";
  }
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t dataset = all[begin].dataset;
    std::vector<std::size_t> methods;
    std::size_t end = begin;
    for (; end < all.size() && all[end].dataset == dataset; ++end) {
      if (all[end].repeat == all[begin].repeat) methods.push_back(all[end].method);
    }
    out += kDatasetLine + std::to_string((end - begin) / methods.size()) + "\t" +
           ranges_text(methods) + "\t" + one_field(sweep.datasets[dataset].label) + "\n";
    begin = end;
  }
  return out;
}

SweepPlan::SweepPlan(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(kMethodLine)) methods_.push_back(line.substr(line.find('\t') + 1));
    if (!line.starts_with(kDatasetLine) || methods_.empty()) continue;
    std::istringstream fields(line.substr(line.find('\t') + 1));
    Dataset dataset;
    std::string repeats;
    std::string ranges;
    std::getline(fields, repeats, '\t');
    std::getline(fields, ranges, '\t');
    std::getline(fields, dataset.label);
    std::istringstream(repeats) >> dataset.repeats;
    dataset.methods = numbers_of(ranges, methods_.size() - 1);
    size_ += dataset.repeats * static_cast<std::int64_t>(dataset.methods.size());
    datasets_.push_back(std::move(dataset));
  }
}

std::string SweepPlan::label(std::int64_t position) const {
  for (const Dataset& dataset : datasets_) {
    const auto methods = static_cast<std::int64_t>(dataset.methods.size());
    if (position >= dataset.repeats * methods) {
      position -= dataset.repeats * methods;
      continue;
    }
    const std::int64_t repeat = position / methods;
    const std::size_t method = dataset.methods[static_cast<std::size_t>(position % methods)];
    return dataset.label + (repeat > 0 ? " (repeat " + std::to_string(repeat) + ")" : "") + " / " +
           methods_[method];
  }
  return "cell " + std::to_string(position);
}

std::vector<std::string> missing_shards(const std::string& lines) {
  std::map<std::string, std::set<std::size_t>> found;  // by "8 DIVISION"
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    const std::size_t slash = line.find('/');
    if (slash == std::string::npos) continue;
    std::size_t number = 0;
    std::istringstream(line.substr(0, slash)) >> number;
    found[line.substr(slash + 1)].insert(number);
  }
  std::vector<std::string> out;
  for (const auto& [division, numbers] : found) {
    std::size_t count = 0;
    std::istringstream(division) >> count;
    for (std::size_t i = 1; i <= std::min(count, kMostShardsListed); ++i) {
      if (!numbers.contains(i)) out.push_back(std::to_string(i) + "/" + std::to_string(count));
    }
  }
  return out;
}

}  // namespace loopbench::harness
