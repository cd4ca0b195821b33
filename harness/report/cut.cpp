#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/report/data.hpp"
#include "harness/report/packed.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kMostSections = 600;  // per kind; more are thinner than a pixel

struct CutKind {
  std::size_t all = 0;
  std::vector<double> begin, end;
  std::vector<std::string> names;
  std::vector<std::size_t> what;

  void add(const methods::Section& section, double origin) {
    ++all;
    if (begin.size() == kMostSections) return;
    begin.push_back(section.begin - origin);
    end.push_back(section.end - origin);
    const auto known = std::ranges::find(names, section.what);
    what.push_back(static_cast<std::size_t>(known - names.begin()));
    if (known == names.end()) names.push_back(section.what);
  }
};

}  // namespace

nlohmann::json sections_json(const std::vector<methods::Section>& sections, double origin) {
  std::vector<std::string> order;
  std::map<std::string, CutKind> kinds;
  for (const methods::Section& section : sections) {
    const auto [found, is_new] = kinds.try_emplace(section.kind);
    if (is_new) order.push_back(section.kind);
    found->second.add(section, origin);
  }
  nlohmann::json out = nlohmann::json::array();
  for (const std::string& name : order) {
    const CutKind& kind = kinds.at(name);
    out.push_back({{"kind", name},
                   {"all", kind.all},
                   {"begin", packed(kind.begin)},
                   {"end", packed(kind.end)},
                   {"names", kind.names},
                   {"choices", kind.what}});
  }
  return out;
}

}  // namespace loopbench::harness
