#include "harness/store/plan.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostShardsListed = 100'000;
constexpr std::size_t kMostCells = 100'000'000;  // a damaged plan can state any number
constexpr const char* kMethodLine = "method\t";
constexpr const char* kDatasetLine = "dataset\t";

/// A label on one line without tabs.
std::string one_field(std::string label) {
  std::ranges::replace_if(
      label, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return label;
}

}  // namespace

std::string plan_text(const Sweep& sweep, const std::vector<Cell>& all) {
  std::string out;
  for (const MethodChoice& method : sweep.methods) {
    out += kMethodLine + one_field(method.label) + "\n";
  }
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t dataset = all[begin].dataset;
    std::string methods;
    std::size_t end = begin;
    std::size_t count = 0;  // of methods
    for (; end < all.size() && all[end].dataset == dataset; ++end) {
      if (all[end].repeat != all[begin].repeat) continue;
      methods += (count++ > 0 ? " " : "") + std::to_string(all[end].method);
    }
    out += kDatasetLine + std::to_string((end - begin) / count) + "\t" + methods + "\t" +
           one_field(sweep.datasets[dataset].label) + "\n";
    begin = end;
  }
  return out;
}

std::vector<std::string> planned_labels(const std::string& text) {
  std::vector<std::string> out;
  std::vector<std::string> methods;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(kMethodLine)) methods.push_back(line.substr(line.find('\t') + 1));
    if (!line.starts_with(kDatasetLine)) continue;
    std::istringstream fields(line.substr(line.find('\t') + 1));
    int repeats = 0;
    std::string numbers;
    std::string dataset;
    fields >> repeats;
    fields.ignore();
    std::getline(fields, numbers, '\t');
    std::getline(fields, dataset);
    std::vector<std::string> own;
    std::istringstream words(numbers);
    for (std::size_t method = 0; words >> method && method < methods.size();) {
      own.push_back(methods[method]);
    }
    for (int repeat = 0; repeat < repeats && !own.empty() && out.size() < kMostCells; ++repeat) {
      const std::string number = repeat > 0 ? " (repeat " + std::to_string(repeat) + ")" : "";
      for (const std::string& method : own) out.push_back(dataset + number + " / " + method);
    }
  }
  return out;
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
