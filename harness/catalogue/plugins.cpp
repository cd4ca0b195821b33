#include "harness/catalogue/plugins.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstring>

#include "datasets/core/error.hpp"

namespace loopbench::harness {

std::vector<PluginEntry> load_plugin(const std::filesystem::path& object) {
  const auto rejection = [&](const std::string& why) {
    return InputError("plugin " + object.string() + ": " + why);
  };
  // An absolute path keeps dlopen from searching the library path for a bare name.
  const std::string path = std::filesystem::absolute(object).string();
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);  // never closed, see the header
  if (handle == nullptr) throw rejection(dlerror());
  auto* describe = reinterpret_cast<const void* (*)()>(dlsym(handle, "loopbench_plugin"));
  if (describe == nullptr) throw rejection("has no LOOPBENCH_PLUGIN line");
  const void* exported = describe();
  int interface = 0;
  std::memcpy(&interface, exported, sizeof interface);
  if (interface != Abi{}.interface) {
    throw rejection(fmt::format(
        "was built for plugin interface {}, this program has {}", interface, Abi{}.interface));
  }
  const auto& plugin = *static_cast<const Plugin*>(exported);
  const Abi ours;
  for (std::size_t i = 0; i < ours.properties.size(); ++i) {
    const auto [name, expected] = ours.properties[i];
    const long found = plugin.abi.properties[i].value;
    if (found != expected) {
      throw rejection(fmt::format("was built with {} = {}, expected {}", name, found, expected));
    }
  }
  return plugin.entries();
}

}  // namespace loopbench::harness
