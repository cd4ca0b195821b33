#include "harness/catalogue/plugins.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <map>
#include <mutex>

#include "datasets/core/error.hpp"
#include "datasets/core/pack.hpp"
#include "harness/base/own_process.hpp"
#include "harness/catalogue/floating_point_guard.hpp"
#include "harness/catalogue/libraries.hpp"

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

template <class Archive, Either<OptionInfo> T>
void walk(Archive& a, T& option) {
  a(option.name)(option.value)(option.help)(option.rule)(option.is_text)(option.is_optional);
}

}  // namespace loopbench

namespace loopbench::harness {
namespace {

using std::filesystem::path;

/// An entry without its functions.
struct Description {
  std::size_t type = 0;  ///< of PluginEntry
  std::string name;
  std::string summary;
  std::vector<OptionInfo> options;
  methods::Kind kind = methods::Kind::joint;
  bool is_oracle = false;
  bool needs_reference = true;
  bool has_inspect = false;
  bool has_check_protocol = false;
  std::string missing_part;
};

template <class Archive, Either<Description> T>
void walk(Archive& a, T& d) {
  a(d.type)(d.name)(d.summary)(d.options)(d.kind)(d.is_oracle)(d.needs_reference);
  a(d.has_inspect)(d.has_check_protocol)(d.missing_part);
}

Description description_of(const PluginEntry& entry) {
  Description out;
  out.type = entry.index();
  const auto add = [&](const auto& each) {
    out.name = each.name;
    out.summary = each.summary;
    out.options = each.options;
    if constexpr (requires { each.kind; }) out.kind = each.kind;
    if constexpr (requires { each.make_oracle; }) out.is_oracle = each.make_oracle != nullptr;
    if constexpr (requires { each.needs_reference; }) out.needs_reference = each.needs_reference;
    if constexpr (requires { each.inspect; }) out.has_inspect = each.inspect != nullptr;
    if constexpr (requires { each.missing_part; }) out.missing_part = each.missing_part;
    if constexpr (requires { each.check_protocol; }) {
      out.has_check_protocol = each.check_protocol != nullptr;
    }
  };
  std::visit(add, entry);
  return out;
}

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

PluginEntry entry_of(const Description& d, const path& object, std::size_t i) {
  if (d.type == 0) {
    using Entry = methods::MethodEntry;
    Entry out{d.name, d.kind, d.summary, d.options, {}};
    out.make = [=](const Params& given) {
      return made(object, d.name, [&] { return loaded_entry<Entry>(object, i).make(given); });
    };
    if (!d.is_oracle) return out;
    out.make_oracle = [=](const Params& given, const Trajectory& reference) {
      return made(object, d.name, [&] {
        return loaded_entry<Entry>(object, i).make_oracle(given, reference);
      });
    };
    return out;
  }
  if (d.type == 1) {
    using Entry = DatasetEntry;
    Entry out{d.name, d.summary, d.options, {}, {}, {}, d.missing_part, {}};
    out.check = [=](const Params& given) {
      check_in_own_process([&] { loaded_entry<Entry>(object, i).check(given); });
    };
    out.load = [=](const Params& given, const DataRoot& root) {
      return loaded_entry<Entry>(object, i).load(given, root);
    };
    if (!d.has_inspect) return out;
    out.inspect = [=](const Params& given, const DataRoot& root) {
      loaded_entry<Entry>(object, i).inspect(given, root);
    };
    return out;
  }
  using Entry = metrics::MetricEntry;
  Entry out;
  out.name = d.name;
  out.summary = d.summary;
  out.options = d.options;
  out.needs_reference = d.needs_reference;
  out.check = [=](const Params& given) {
    check_in_own_process([&] { loaded_entry<Entry>(object, i).check(given); });
  };
  if (d.has_check_protocol) {
    out.check_protocol = [=](const Params& given, const metrics::Protocol& protocol) {
      check_in_own_process([&] { loaded_entry<Entry>(object, i).check_protocol(given, protocol); });
    };
  }
  out.score = [=](const metrics::Evaluation& evaluation, const Params& given) {
    return loaded_entry<Entry>(object, i).score(evaluation, given);
  };
  return out;
}

std::string packed_description(const path& object) {
  std::vector<Description> entries;
  for (const PluginEntry& entry : load_plugin(object)) entries.push_back(description_of(entry));
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
  for (std::size_t i = 0; i < entries.size(); ++i) {
    out.entries.push_back(entry_of(entries[i], file, i));
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
