#include "tests/plugin/zoo/beast.hpp"

namespace loopbench::zoo {
namespace {

std::vector<harness::PluginEntry> all() {
  std::vector<harness::PluginEntry> out;
  for (auto* part : {crashing, hanging, breeding, meddling, greedy, lying}) {
    for (methods::MethodEntry& entry : part()) out.emplace_back(std::move(entry));
  }
  return out;
}

}  // namespace
}  // namespace loopbench::zoo

extern "C" const void* loopbench_plugin() {
  static const loopbench::harness::Plugin plugin{{}, loopbench::zoo::all};
  return &plugin;
}
