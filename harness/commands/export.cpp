#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <optional>

#include "datasets/core/fields.hpp"
#include "datasets/files/replace_file.hpp"
#include "harness/answers/tables/benchmark_json.hpp"
#include "harness/answers/tables/record_csv.hpp"
#include "harness/answers/tables/store_tables.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/write_output.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/run/estimate_files.hpp"
#include "harness/sweep/store/open.hpp"
#include "harness/sweep/store/read.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

/// The text with '_' for what is not a letter, digit, '.', '-' or '+'.
std::string file_name(std::string text) {
  for (char& c : text) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+';
    if (!is_plain) c = '_';
  }
  return text;
}

std::string repeat_suffix(const CellRow& cell) {
  return cell.repeat > 0 ? fmt::format("-repeat{}", cell.repeat) : "";
}

/// Files to write into one folder.
class ExportedFiles {
 public:
  using Read = std::function<std::string()>;  // again when it is written: all are too many to keep

  /// Adds a file under this name, or NUMBER-NAME if that is taken. Returns the name, or "" without
  /// text.
  std::string add(std::string name, const std::string& comments, const Read& read) {
    if (read().empty()) return "";
    if (files_.contains(name)) name = fmt::format("{}-{}", files_.size(), name);
    files_.emplace(name, [=] { return comments + read(); });
    return name;
  }

  void write(const std::filesystem::path& folder, const std::string& index) const {
    std::vector<OutputFile> outputs{{"--out", folder / "index.csv", FileKind::printed}};
    for (const auto& [name, read] : files_) {
      outputs.push_back({"--out", folder / name, FileKind::trajectory});
    }
    require_writable(outputs);
    for (const auto& [name, read] : files_) write_file(folder / name, read());
    write_file(folder / "index.csv", index);
  }

 private:
  std::map<std::string, Read> files_;  ///< content by name
};

int export_trajectories(const std::filesystem::path& store, const std::filesystem::path& out) {
  if (out.empty()) throw InputError("export --what trajectories: expected -o FOLDER");
  reject_standard_output("-o", out);
  const std::filesystem::path saved = store_file(store).parent_path() / "trajectories";
  ExportedFiles files;
  std::map<std::string, std::string> references;  // file of each content
  std::string index = "file,reference,key,sequence,repeat,method,times\n";
  std::size_t with = 0, without = 0;
  for (const CellRow& cell : read_cells(store)) {
    bool has_file = false;
    const std::string content(cell.content);
    const std::string sequence = cell.sequence.text(), method = cell.method.text();
    for (const metrics::Times times : kAllTimes) {
      const std::string name = files.add(
          file_name(sequence + "-" + method + repeat_suffix(cell) + "-" + to_text(times) + ".txt"),
          fmt::format("# sequence: {}\n# repeat: {}\n# method: {}\n# times: {}\n# key: {}\n",
                      printable(sequence),
                      cell.repeat,
                      printable(method),
                      to_text(times),
                      cell.key),
          [=, key = cell.key] { return saved_estimate(saved, key, times); });
      if (name.empty()) continue;
      has_file = true;
      ++with;
      const auto [reference, is_new] = references.try_emplace(content);
      if (is_new) {
        const std::string own = file_name("reference-" + sequence + repeat_suffix(cell) + ".txt");
        reference->second = files.add(own, "", [=] { return saved_reference(saved, content); });
      }
      index += fmt::format("{},{},{},{},{},{},{}\n",
                           name,
                           reference->second,
                           cell.key,
                           quoted(sequence),
                           cell.repeat,
                           quoted(method),
                           to_text(times));
    }
    if (!has_file) ++without;
  }
  if (with == 0) {
    throw InputError(store.string() +
                     ": has no saved trajectories; compute its cells with `run "
                     "CONFIG --save-trajectories --retry all`");
  }
  files.write(out, index);
  fmt::print("{} with references and index.csv in {}\n", counted(with, "file"), out.string());
  if (without > 0) fmt::print("{} without a saved trajectory\n", counted(without, "cell"));
  return kExitOk;
}

/// Streams the long table. The file is complete or not there.
void export_rows(const std::filesystem::path& store, const std::filesystem::path& file) {
  const StoreProvenance provenance = read_store_provenance(store);
  std::optional<PendingFile> pending;
  if (!file.empty() && !is_dash(file)) {
    require_writable({provenance_output(file.string())});
    std::error_code ignored;  // a failure is reported when the file is created
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
    pending.emplace(file, Target::named);
  }
  const auto write = [&](std::string_view bytes) {
    if (pending) return pending->write(bytes);
    std::fwrite(bytes.data(), 1, bytes.size(), stdout);  // main() reports write errors
  };
  std::string text = rows_header();
  const auto flush = [&] {
    write(text);
    text.clear();
  };
  constexpr std::size_t kBlock = std::size_t{1} << 20;  // [bytes]
  for_each_record(store, [&](const Record& record) {
    text += csv_row(record);
    if (text.size() >= kBlock) flush();
  });
  flush();
  if (pending) pending->commit();
  write_provenance_of_csv(provenance, file.string());
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
  struct Arguments {
    std::filesystem::path store;
    std::string what = "rows";
    std::filesystem::path out;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("export", "Write the rows, trajectories or costs of a store");
  declare_store(*command, a->store);
  add(*command,
      "--what",
      a->what,
      "rows: every score, as CSV; trajectories: TUM files of the estimates and references, with "
      "index.csv, see `run --save-trajectories`; benchmark: costs and their growth as JSON of "
      "Google Benchmark; notes: what is known about the runs besides their scores, as JSON")
      ->check(CLI::IsMember({"rows", "trajectories", "benchmark", "notes"}))
      ->capture_default_str();
  writes(*command,
         command->add_option("-o,--out", a->out, "File (default: standard output), or folder"),
         FileKind::printed);
  command->callback([a, &exit_code] {
    if (a->what == "trajectories") {
      exit_code = export_trajectories(a->store, a->out);
      return;
    }
    exit_code = kExitOk;
    if (a->what == "benchmark") {
      write_file(a->out.empty() ? "-" : a->out,
                 benchmark_json(read_cells(a->store),
                                read_provenance(a->store),
                                texts(counted_notes(a->store), Severity::info)));
      return;
    }
    if (a->what == "notes") {
      write_file(a->out.empty() ? "-" : a->out, json(counted_notes(a->store)) + "\n");
      return;
    }
    export_rows(a->store, a->out);
  });
}

}  // namespace loopbench::harness
