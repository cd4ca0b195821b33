#include "harness/sweep/catalogue/catalogue.hpp"

#include <algorithm>

#include "datasets/images/rgbd_datasets.hpp"
#include "harness/sweep/catalogue/command_dataset.hpp"
#include "harness/sweep/catalogue/command_metric.hpp"
#include "harness/sweep/catalogue/external_methods.hpp"
#include "harness/sweep/catalogue/loading.hpp"
#include "harness/sweep/catalogue/plugins.hpp"
#include "harness/sweep/process/own_process.hpp"
#include "harness/sweep/text/hash.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {
namespace {

template <class Entry>
const Entry& find(const std::vector<Entry>& entries,
                  const std::string& kind,
                  const std::string& name) {
  const auto found = std::ranges::find(entries, name, &Entry::name);
  if (found != entries.end()) return *found;
  std::vector<std::string> known;
  for (const Entry& entry : entries) known.push_back(entry.name);
  throw InputError(unknown_name(kind, name, known));
}

/// Hashes of a plugin's file and of the libraries that it loads.
std::string version_of(const std::filesystem::path& plugin,
                       const std::vector<std::filesystem::path>& libraries) {
  std::string out = hex(hash_of_file(plugin));
  for (const std::filesystem::path& library : libraries) {
    out += ", " + library.filename().string() + " " + hex(hash_of_file(library));
  }
  return out;
}

void add_plugin(Catalogue& catalogue, const std::filesystem::path& plugin) {
  DescribedPlugin described = describe_plugin(plugin);
  const std::string version = version_of(plugin, described.libraries);  // it is a file
  const auto add = [&](auto& entries, const std::string& kind, auto& entry) {
    for (const auto& other : entries) {
      if (other.name != entry.name) continue;
      throw InputError("plugin " + plugin.string() + ": " + kind + " '" + entry.name +
                       "' is already in the catalogue");
    }
    catalogue.versions.emplace(kind + " " + entry.name, version);
    entries.push_back(std::move(entry));
  };
  for (PluginEntry& entry : described.entries) {
    if (auto* method = std::get_if<methods::MethodEntry>(&entry)) {
      add(catalogue.methods, "method", *method);
    } else if (auto* dataset = std::get_if<DatasetEntry>(&entry)) {
      add(catalogue.datasets, "dataset", *dataset);
    } else {
      add(catalogue.metrics, "metric", std::get<metrics::MetricEntry>(entry));
    }
  }
}

}  // namespace

Catalogue catalogue(const std::vector<std::filesystem::path>& plugins) {
  Catalogue out{datasets(), methods::methods(), metrics::metrics(), {}};
  for (DatasetEntry& entry : rgbd::rgbd_datasets(loading_progress())) {
    out.datasets.push_back(std::move(entry));
  }
  out.datasets.push_back(command_dataset(cache_folder()));
  out.methods.push_back(command_entry());
  out.metrics.push_back(command_metric());
  for (const std::filesystem::path& plugin : plugins) add_plugin(out, plugin);
  return out;
}

bool is_joint(const Catalogue& catalogue,
              const methods::MethodEntry& entry,
              const Params& options) {
  using Joint = std::unique_ptr<const methods::Estimator>;
  const auto makes_joint = [&] { return std::holds_alternative<Joint>(entry.make(options)); };
  if (plugin_version(catalogue, "method", entry.name).empty()) return makes_joint();
  try {
    const auto work = [&] { return std::string(makes_joint() ? "joint" : ""); };
    return in_own_process(work, {.seconds = kLongestCheck}) == "joint";
  } catch (const OptionError&) {
    throw;
  } catch (const std::exception&) {  // its cells will fail for the same reason and report it
    return entry.kind == methods::Kind::joint;
  }
}

bool has_foreign_code(const Catalogue& catalogue, const Choice& dataset) {
  return is_program(dataset) || !plugin_version(catalogue, "dataset", dataset.name).empty();
}

std::string plugin_version(const Catalogue& catalogue,
                           const std::string& kind,
                           const std::string& name) {
  const auto found = catalogue.versions.find(kind + " " + name);
  return found == catalogue.versions.end() ? "" : found->second;
}

const DatasetEntry& find_dataset(const Catalogue& catalogue, const std::string& name) {
  return find(catalogue.datasets, "dataset", name);
}
const methods::MethodEntry& find_method(const Catalogue& catalogue, const std::string& name) {
  return find(catalogue.methods, "method", name);
}
bool is_oracle(const Catalogue& catalogue, const std::string& name) {
  const auto found = std::ranges::find(catalogue.methods, name, &methods::MethodEntry::name);
  return found != catalogue.methods.end() && found->make_oracle;
}
bool uses_reference(const MethodChoice& method, const Catalogue& catalogue) {
  return std::ranges::any_of(method.stages,
                             [&](const Choice& stage) { return is_oracle(catalogue, stage.name); });
}
const metrics::MetricEntry& find_metric(const Catalogue& catalogue, const std::string& name) {
  return find(catalogue.metrics, "metric", name);
}

}  // namespace loopbench::harness
