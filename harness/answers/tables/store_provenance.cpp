#include "harness/answers/tables/store_provenance.hpp"

#include <nlohmann/json.hpp>
#include <sstream>

#include "harness/answers/tables/table.hpp"
#include "harness/sweep/store/read.hpp"
#include "harness/sweep/text/pattern.hpp"

namespace loopbench::harness {
namespace {

using ProvenanceJson = nlohmann::ordered_json;

/// "key: value", or "key:" and indented lines for a multi-line value.
void add_entry(std::vector<std::string>& out, const std::string& key, const std::string& value) {
  std::istringstream in(value);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  if (lines.empty()) return;
  if (lines.size() == 1) return out.push_back(key + ": " + lines.front());
  out.push_back(key + ":");
  for (const std::string& line : lines) out.push_back("  " + line);
}

/// Rows of the table run that describe the state of the store, not its contents.
bool is_internal(const std::string& key) { return key == "planned" || key == "shard"; }

std::vector<std::string> provenance_entries(const StoreProvenance& provenance) {
  std::vector<std::string> out;
  for (const auto& [key, value] : provenance.provenance) add_entry(out, key, value);
  for (const auto& [sequence, files] : provenance.inputs) {
    std::string text;
    for (const InputFile& file : files) {
      text += file.path + " " + std::to_string(file.bytes) + " bytes " + file.hash + "\n";
    }
    add_entry(out, "read for " + sequence, text);
  }
  for (const auto& [key, value] : provenance.run) {
    if (!is_internal(key)) add_entry(out, key, value);
  }
  for (const std::string& note : texts(provenance.notes, Severity::info)) {
    add_entry(out, "note", note);
  }
  return out;
}

/// `line` with absolute paths cut to their last two parts: folders of a machine are of no use to
/// others.
std::string without_folders(const std::string& line) {
  static const Pattern kPath(R"((^|[\s"'=:,([{])/[^\s"',)\]}]*/([^\s"',)\]}/]+/[^\s"',)\]}/]+))");
  return kPath.replaced(line, R"(\1\2)");
}

ProvenanceJson json_of(const StoreProvenance& provenance) {
  ProvenanceJson inputs = ProvenanceJson::object();
  for (const auto& [sequence, files] : provenance.inputs) {
    ProvenanceJson list = ProvenanceJson::array();
    for (const InputFile& file : files) {
      list.push_back({{"path", file.path}, {"bytes", file.bytes}, {"xxh3_128", file.hash}});
    }
    inputs[sequence] = std::move(list);
  }
  std::map<std::string, std::string> run = provenance.run;
  std::erase_if(run, [](const auto& entry) { return is_internal(entry.first); });
  return {{"run", run},
          {"provenance", provenance.provenance},
          {"inputs", std::move(inputs)},
          {"notes", ProvenanceJson::parse(json(provenance.notes))}};
}

std::string dumped(const ProvenanceJson& value) {
  return value.dump(2, ' ', false, ProvenanceJson::error_handler_t::replace);
}

}  // namespace

StoreProvenance read_store_provenance(const std::filesystem::path& store) {
  return {read_run(store), read_provenance(store), read_inputs(store), counted_notes(store)};
}

std::string json(const StoreProvenance& provenance) { return dumped(json_of(provenance)) + "\n"; }

std::string with_provenance(const StoreProvenance& provenance,
                            const std::string& key,
                            const std::string& value) {
  std::string body = value;
  while (body.ends_with('\n')) body.pop_back();
  return "{\n\"provenance\": " + dumped(json_of(provenance)) + ",\n" + dumped(key) + ": " + body +
         "\n}\n";
}

std::string provenance_lines(const StoreProvenance& provenance, const std::string& mark) {
  std::string out;
  for (const std::string& line : provenance_entries(provenance)) {
    out += mark + without_folders(one_line(line)) + "\n";
  }
  return out;
}

std::string provenance_comment(const StoreProvenance& provenance) {
  std::string text = provenance_lines(provenance, "");
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at)) {
    text.insert(at + 1, " ");
  }
  return "<!-- provenance\n" + text + "-->\n";
}

std::filesystem::path provenance_file(const std::filesystem::path& file) {
  std::filesystem::path out = file;
  return out.replace_extension(".provenance.json");
}

}  // namespace loopbench::harness
