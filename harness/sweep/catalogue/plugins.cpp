#include "harness/sweep/catalogue/plugins.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <map>
#include <mutex>

#include "datasets/core/error.hpp"
#include "datasets/core/pack.hpp"
#include "harness/sweep/catalogue/floating_point_guard.hpp"
#include "harness/sweep/catalogue/libraries.hpp"
#include "harness/sweep/process/own_process.hpp"

namespace loopbench {

template <class Archive, Either<Param> T>
void walk(Archive& a, T& value) {
  std::size_t index = value.index();
  a(index);
  if constexpr (!std::is_const_v<T>) {
    const std::array<Param, 4> types{false, std::int64_t{}, 0.0, std::string()};
    value = types.at(index);
  }
  std::visit([&](auto& held) { a(held); }, value);
}

template <class Archive, Either<OptionRange> T>
void walk(Archive& a, T& range) {
  a(range.low)(range.high)(range.is_open);
}

template <class Archive, Either<OptionInfo> T>
void walk(Archive& a, T& option) {
  a(option.name)(option.value)(option.help)(option.rule)(option.is_text)(option.is_optional)(
      option.range)(option.words);
}

}  // namespace loopbench

namespace loopbench::harness {
namespace {

using std::filesystem::path;

/// An entry without its functions, and whether it has the optional one.
struct Description {
  PluginEntry entry;
  bool has_optional = false;
};

template <class Archive, Either<Description> T>
void walk(Archive& a, T& d) {
  std::size_t type = d.entry.index();
  a(type)(d.has_optional);
  if constexpr (!std::is_const_v<T>) {
    const std::array<PluginEntry, 3> types{
        methods::MethodEntry{}, DatasetEntry{}, metrics::MetricEntry{}};
    d.entry = types.at(type);
  }
  const auto add = [&](auto& each) {
    a(each.name)(each.summary)(each.options);
    if constexpr (requires { each.kind; }) a(each.kind);
    if constexpr (requires { each.missing_part; }) a(each.missing_part);
    if constexpr (requires { each.needs_reference; }) a(each.needs_reference);
  };
  std::visit(add, d.entry);
}

bool has_function(const methods::MethodEntry& entry) { return entry.make_oracle != nullptr; }
bool has_function(const DatasetEntry& entry) { return entry.inspect != nullptr; }
bool has_function(const metrics::MetricEntry& entry) { return entry.check_protocol != nullptr; }

/// Entry `index` of a plugin, which is loaded by the first call.
template <class Entry>
const Entry& loaded_entry(const path& object, std::size_t index) {
  static std::mutex mutex;
  static std::map<path, std::vector<PluginEntry>> loaded;
  const std::lock_guard lock(mutex);
  auto found = loaded.find(object);
  if (found == loaded.end()) {
    const FloatingPointGuard guard;  // objects compiled with -ffast-math set it when they load
    found = loaded.emplace(object, load_plugin(object)).first;
  }
  return std::get<Entry>(found->second.at(index));
}

/// A check by the plugin, in a process of its own. If that fails, what uses the plugin will report
/// it.
template <class Check>
void check_in_own_process(const Check& check) {
  try {
    const auto work = [&] {
      check();
      return std::string();
    };
    in_own_process(work, {.seconds = kLongestCheck});
  } catch (const OptionError&) {
    throw;
  } catch (const std::exception&) {
  }
}

/// What `make` returns; its exceptions, of the plugin's code, with the names of both.
template <class Make>
methods::Stage made(const path& object, const std::string& method, const Make& make) {
  const auto error = [&](const char* why) {
    return std::runtime_error(
        fmt::format("plugin {}: method '{}': {}", object.filename().string(), method, why));
  };
  try {
    return make();
  } catch (const OptionError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& reason) {
    throw error(reason.what());
  } catch (...) {
    throw error("threw an exception that is not a std::exception");
  }
}

// These set the functions of entry `i` of a plugin.

void set_functions(methods::MethodEntry& out, bool is_oracle, const path& object, std::size_t i) {
  using Entry = methods::MethodEntry;
  const std::string name = out.name;
  out.make = [=](const Params& given) {
    return made(object, name, [&] { return loaded_entry<Entry>(object, i).make(given); });
  };
  if (!is_oracle) return;
  out.make_oracle = [=](const Params& given, const Trajectory& reference) {
    return made(
        object, name, [&] { return loaded_entry<Entry>(object, i).make_oracle(given, reference); });
  };
}

template <class Entry>
void set_check(Entry& out, const path& object, std::size_t i) {
  out.check = [=](const Params& given) {
    check_in_own_process([&] { loaded_entry<Entry>(object, i).check(given); });
  };
}

void set_functions(DatasetEntry& out, bool has_inspect, const path& object, std::size_t i) {
  set_check(out, object, i);
  out.load = [=](const Params& given, const DataRoot& root) {
    return loaded_entry<DatasetEntry>(object, i).load(given, root);
  };
  if (!has_inspect) return;
  out.inspect = [=](const Params& given, const DataRoot& root) {
    loaded_entry<DatasetEntry>(object, i).inspect(given, root);
  };
}

void set_functions(metrics::MetricEntry& out,
                   bool has_check_protocol,
                   const path& object,
                   std::size_t i) {
  using Entry = metrics::MetricEntry;
  set_check(out, object, i);
  if (has_check_protocol) {
    out.check_protocol = [=](const Params& given, const metrics::Protocol& protocol) {
      check_in_own_process([&] { loaded_entry<Entry>(object, i).check_protocol(given, protocol); });
    };
  }
  out.score = [=](const metrics::Evaluation& evaluation, const Params& given) {
    return loaded_entry<Entry>(object, i).score(evaluation, given);
  };
}

std::string packed_description(const path& object) {
  std::vector<Description> entries;
  for (const PluginEntry& entry : load_plugin(object)) {
    const bool has = std::visit([](const auto& each) { return has_function(each); }, entry);
    entries.push_back({entry, has});
  }
  std::vector<std::string> libraries;
  for (const path& library : plugin_libraries(object)) libraries.push_back(library.string());
  Packer pack;
  pack(entries)(libraries);
  return pack.bytes();
}

}  // namespace

DescribedPlugin describe_plugin(const path& object, double seconds) {
  const path file = std::filesystem::absolute(object);  // cells may run in another folder
  std::vector<Description> entries;
  std::vector<std::string> libraries;
  program_libraries();  // before those of plugins are loaded
  try {
    const std::string packed =
        in_own_process([&] { return packed_description(object); }, {.seconds = seconds});
    Unpacker unpack(packed);
    unpack(entries)(libraries);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError("plugin " + object.string() + ": a process that loaded it " + error.what());
  }
  DescribedPlugin out;
  for (Description& each : entries) {
    const std::size_t i = out.entries.size();
    std::visit([&](auto& entry) { set_functions(entry, each.has_optional, file, i); }, each.entry);
    out.entries.push_back(std::move(each.entry));
  }
  out.libraries.assign(libraries.begin(), libraries.end());
  return out;
}

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
