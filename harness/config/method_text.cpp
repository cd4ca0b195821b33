#include "harness/config/method_text.hpp"

namespace loopbench::harness {

std::vector<std::string> split_stages(const std::string& text) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  while (true) {
    const std::size_t plus = text.find('+', begin);
    std::string name = text.substr(begin, plus == std::string::npos ? plus : plus - begin);
    const std::size_t first = name.find_first_not_of(" \t");
    name = first == std::string::npos
               ? ""
               : name.substr(first, name.find_last_not_of(" \t") - first + 1);
    out.push_back(name);
    if (plus == std::string::npos) return out;
    begin = plus + 1;
  }
}

std::string why_not_composable(const std::vector<const methods::MethodEntry*>& stages) {
  if (stages.size() == 1) return "";
  if (stages.size() == 2 && stages[0]->kind == methods::Kind::corrector &&
      stages[1]->kind == methods::Kind::smoother) {
    return "";
  }
  std::string kinds;
  for (const methods::MethodEntry* stage : stages) {
    kinds += (kinds.empty() ? "" : " + ") + to_text(stage->kind);
  }
  return "is " + kinds + "; stages compose as corrector + smoother";
}

}  // namespace loopbench::harness
