#include "tests/plugin/zoo/beast.hpp"

namespace loopbench::zoo {
namespace {

std::vector<methods::MethodEntry> all() {
  std::vector<methods::MethodEntry> out;
  for (auto* part : {crashing, hanging, breeding, meddling, greedy, lying, breaking_out}) {
    for (methods::MethodEntry& entry : part()) out.push_back(std::move(entry));
  }
  return out;
}

}  // namespace
}  // namespace loopbench::zoo

extern "C" const loopbench::methods::Plugin* loopbench_plugin() {
  static const loopbench::methods::Plugin plugin{{}, loopbench::zoo::all};
  return &plugin;
}
