#include "tests/plugin/zoo/beast.hpp"

namespace loopbench::zoo {

std::vector<harness::PluginEntry>& beasts() {
  static std::vector<harness::PluginEntry> all;
  return all;
}

}  // namespace loopbench::zoo

extern "C" const void* loopbench_plugin() {
  static const loopbench::harness::Plugin plugin{{}, [] { return loopbench::zoo::beasts(); }};
  return &plugin;
}
