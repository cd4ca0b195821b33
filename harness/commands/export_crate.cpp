#include "harness/commands/export_crate.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <utility>

#include "datasets/core/error.hpp"
#include "harness/base/run_filter.hpp"
#include "harness/base/write_file.hpp"
#include "harness/store/open.hpp"
#include "harness/store/read.hpp"
#include "harness/tables/store_provenance.hpp"

namespace loopbench::harness {
namespace {

using Entity = nlohmann::ordered_json;

Entity reference_to(const std::string& id) { return {{"@id", id}}; }

std::string day_of_last_change(const std::filesystem::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) throw InputError(file.string() + ": cannot be read");
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(status.st_mtime));
}

std::string description_of(const std::vector<CellRecord>& cells, const std::string& version) {
  std::set<std::string> methods, sequences;
  for (const CellRecord& cell : cells) {
    methods.insert(cell.method);
    sequences.insert(cell.sequence);
  }
  return fmt::format(
      "Scores of loop-closure correction by loopbench {}: methods: {}, sequences: {}, "
      "cells: {}",
      version,
      methods.size(),
      sequences.size(),
      cells.size());
}

/// The option `licence` in "DATASET: a=1, licence=CC BY 4.0, ..."; empty if it has none.
std::string licence_in(const std::string& options) {
  static const std::regex kLicence(R"((?:: |, )licence=(.*?)(?:, [a-z_.]+=|$))");
  std::smatch found;
  return std::regex_search(options, found, kLicence) ? found[1].str() : "";
}

/// 64 hexadecimal digits, by the program sha256sum. Throws InputError.
std::string sha256_of_file(const std::filesystem::path& file) {
  constexpr std::size_t kDigits = 64;
  const FilterResult result = run_filter({"sha256sum", "--zero", "--", file.string()});
  if (result.exit_code != 0) throw InputError(file.string() + ": cannot be read");
  return result.output.substr(0, kDigits);
}

class Crate {
 public:
  Crate(const std::filesystem::path& store, std::filesystem::path folder)
      : store_(store), folder_(std::move(folder)), provenance_(read_store_provenance(store)) {}

  std::string metadata(const std::vector<std::string>& files, const std::string& config) {
    add_inputs();
    Entity parts = Entity::array(), results = Entity::array();
    for (const std::string& file : files) {
      add_file(file);
      parts.push_back(reference_to(file));
      (file == config ? inputs_ : results).push_back(reference_to(file));
    }
    const std::string version = text(provenance_.run, "loopbench");
    const std::string sweep = text(provenance_.run, "sweep");
    Entity root{{"@id", "./"},
                {"@type", "Dataset"},
                {"name", "loopbench: " + sweep},
                {"description", description_of(read_cells(store_), version)},
                {"datePublished", day_of_last_change(store_file(store_))},
                {"hasPart", parts},
                {"mentions", reference_to("#run")}};
    if (!licences_.empty()) root["license"] = licences_;
    const Entity run{{"@id", "#run"},
                     {"@type", "CreateAction"},
                     {"name", "loopbench run of " + sweep},
                     {"instrument", reference_to("#loopbench")},
                     {"object", inputs_},
                     {"result", results}};
    const Entity program{{"@id", "#loopbench"},
                         {"@type", "SoftwareApplication"},
                         {"name", "loopbench"},
                         {"softwareVersion", version},
                         {"description",
                          fmt::format("commit {} ({}), {}, {}",
                                      text(provenance_.provenance, "commit"),
                                      text(provenance_.provenance, "source"),
                                      text(provenance_.provenance, "compiler"),
                                      text(provenance_.provenance, "flags"))}};
    const Entity descriptor{{"@id", "ro-crate-metadata.json"},
                            {"@type", "CreativeWork"},
                            {"conformsTo", reference_to("https://w3id.org/ro/crate/1.1")},
                            {"about", reference_to("./")}};
    Entity graph{descriptor, root, run, program};
    for (const Entity& entity : entities_) graph.push_back(entity);
    const Entity context{"https://w3id.org/ro/crate/1.1/context",
                         {{"sha256", "https://schema.org/sha256"}}};
    const Entity document{{"@context", context}, {"@graph", graph}};
    return document.dump(2, ' ', false, Entity::error_handler_t::replace) + "\n";
  }

 private:
  static std::string text(const std::map<std::string, std::string>& values,
                          const std::string& key) {
    const auto found = values.find(key);
    return found == values.end() ? "unknown" : found->second;
  }

  void add_file(const std::string& name) {
    static const std::map<std::string, std::string> kFormats{
        {".csv", "text/csv"}, {".json", "application/json"}, {".yaml", "application/yaml"}};
    const std::filesystem::path file = folder_ / name;
    entities_.push_back({{"@id", name},
                         {"@type", "File"},
                         {"name", name},
                         {"encodingFormat", kFormats.at(file.extension().string())},
                         {"contentSize", std::to_string(std::filesystem::file_size(file))},
                         {"sha256", sha256_of_file(file)}});
  }

  /// The licence of a sequence's data as an entity; null if none is stated.
  Entity licence(const std::string& stated) {
    if (stated.empty()) return nullptr;
    const auto [found, is_new] =
        licence_ids_.try_emplace(stated, fmt::format("#licence-{}", licence_ids_.size() + 1));
    if (is_new) {
      licences_.push_back(reference_to(found->second));
      entities_.push_back({{"@id", found->second},
                           {"@type", "CreativeWork"},
                           {"name", stated},
                           {"description", "licence of input data, as the config states it"}});
    }
    return reference_to(found->second);
  }

  /// Input files by content and name: sequences can share files.
  void add_inputs() {
    const auto options = read_dataset_options(store_);
    std::map<std::pair<std::string, std::string>, Entity> inputs;
    for (const auto& [sequence, files] : provenance_.inputs) {
      const auto own = options.find(sequence);
      const Entity terms = licence(own == options.end() ? "" : licence_in(own->second));
      for (const InputFile& file : files) {
        const std::string name = std::filesystem::path(file.path).filename().string();
        const auto [found, is_new] = inputs.try_emplace({name, file.hash});
        if (!is_new) continue;
        found->second = {{"@type", "CreativeWork"},
                         {"name", name},
                         {"description", "read for " + sequence},
                         {"contentSize", std::to_string(file.bytes)},
                         {"identifier", "murmur3_x64_128:" + file.hash}};
        if (!terms.is_null()) found->second["license"] = terms;
      }
    }
    for (const auto& [key, entity] : inputs) {
      Entity numbered{{"@id", fmt::format("#input-{}", inputs_.size() + 1)}};
      numbered.update(entity);
      inputs_.push_back(reference_to(numbered["@id"]));
      entities_.push_back(std::move(numbered));
    }
  }

  std::filesystem::path store_;
  std::filesystem::path folder_;
  StoreProvenance provenance_;
  std::vector<Entity> entities_;
  std::map<std::string, std::string> licence_ids_;  // by the stated licence
  Entity licences_ = Entity::array();               // references
  Entity inputs_ = Entity::array();                 // references
};

}  // namespace

void write_crate_metadata(const std::filesystem::path& store,
                          const std::filesystem::path& folder,
                          const std::vector<std::string>& files,
                          const std::string& config) {
  write_result(folder / "ro-crate-metadata.json", Crate(store, folder).metadata(files, config));
}

}  // namespace loopbench::harness
