#include "harness/answers/report/page_template.hpp"

#include <stdexcept>

#include "harness/answers/report/assets.hpp"

namespace loopbench::harness {

std::string filled(std::string_view page, const Placeholders& values) {
  std::string out;
  while (true) {
    const std::size_t open = page.find("{{");
    out += page.substr(0, open);
    if (open == std::string_view::npos) return out;
    const std::size_t close = page.find("}}", open);
    const auto found = values.find(page.substr(open + 2, close - open - 2));
    if (found == values.end()) throw std::logic_error("report: a placeholder has no value");
    out += found->second;
    page.remove_prefix(close + 2);
  }
}

std::string asset_text(std::string_view name) {
  for (const Asset& asset : assets()) {
    if (asset.name == name) return std::string(asset.text);
  }
  throw std::logic_error("report: no such asset");
}

}  // namespace loopbench::harness
