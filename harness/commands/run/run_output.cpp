#include "harness/commands/run/run_output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "datasets/core/error.hpp"
#include "harness/answers/tables/pivot.hpp"
#include "harness/answers/tables/reasons.hpp"
#include "harness/answers/tables/record_csv.hpp"
#include "harness/answers/tables/store_provenance.hpp"
#include "harness/answers/tables/summary.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/sweep/catalogue/command_dataset.hpp"
#include "harness/sweep/catalogue/external_methods.hpp"
#include "harness/sweep/catalogue/load_sequence.hpp"
#include "harness/sweep/catalogue/loading.hpp"
#include "harness/sweep/model/where.hpp"
#include "harness/sweep/process/own_process.hpp"
#include "harness/sweep/process/shell.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/run/build.hpp"
#include "harness/sweep/store/store.hpp"
#include "harness/sweep/text/counted.hpp"
#include "harness/sweep/text/print_error.hpp"
#include "harness/sweep/text/printable.hpp"
#include "harness/sweep/text/wrap.hpp"

namespace loopbench::harness {
namespace {

/// The reasons why there are no scores, of records that `selected` selects.
template <class Selected>
std::string reasons_text(const std::vector<Record>& records, Selected selected) {
  std::vector<Missing> missing;
  for (const Record& r : records) {
    const std::string what = r.has_score() ? r.kind->short_name() : "";
    if (selected(r)) missing.push_back({r.cell->method, what, to_text(r.status), r.why});
  }
  std::string out;
  for (const std::string& line : grouped(missing)) out += "- " + printable(line) + "\n";
  return out + (out.empty() ? "" : "\n");
}

/// Loads every sequence of the cells once (with its first seed), or inspects it if loading is slow.
/// Returns "LABEL: reason (CONFIG:LINE)" for each sequence that cannot be loaded. Throws
/// MissingPart if this build cannot read a file.
std::vector<std::string> bad_inputs(const Sweep& sweep,
                                    const std::vector<Cell>& cells,
                                    const Catalogue& catalogue,
                                    const DataRoot& root) {
  std::vector<std::string> out;
  std::set<std::size_t> seen;
  for (const Cell& cell : cells) {
    if (!seen.insert(cell.dataset).second) continue;
    const DatasetChoice& choice = sweep.datasets[cell.dataset];
    const DatasetEntry& entry = find_dataset(catalogue, choice.dataset.name);
    const Limits limits = loading_limits(choice.dataset, sweep.limits);
    const auto add = [&](const std::string& why) {
      out.push_back(choice.label + ": " + with_place(why, choice, sweep));
    };
    try {
      in_own_process(
          [&] {
            if (entry.inspect) {
              entry.inspect(choice.dataset.options, root);
            } else {
              load_sequence(cell, sweep, catalogue, root);
            }
            return std::string();
          },
          {limits.seconds, limits.memory});
    } catch (const MissingPart&) {
      throw;
    } catch (const ProcessFailure& error) {
      add(std::string("a process that loaded it ") + error.what());
    } catch (const std::exception& error) {
      add(error.what());
    }
  }
  return out;
}

/// "[####......] 12/30  8.1 cells/s  2 s left  label".
std::string progress_line(std::size_t done,
                          std::size_t total,
                          double seconds,
                          const std::string& label) {
  const double rate = seconds > 0.0 ? static_cast<double>(done) / seconds : 0.0;
  const double left = rate > 0.0 ? static_cast<double>(total - done) / rate : 0.0;
  const std::string text =
      fmt::format("{:.1f} cells/s  {:.0f} s left  {}", rate, left, printable(label));
  return loading_line(text, done, total);
}

}  // namespace

Progress::Progress(std::size_t total) : visible_(isatty(STDERR_FILENO) == 1), total_(total) {}

Progress::~Progress() {
  if (visible_) print_error("\r\033[K");
}

void Progress::step(const std::string& label) {
  ++done_;
  const auto now = Clock::now();
  if (!visible_ || (done_ < total_ && now - drawn_ < std::chrono::milliseconds(100))) return;
  drawn_ = now;
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  // One column short, because writing the last column wraps on some terminals.
  const std::string line = progress_line(done_, total_, seconds, label);
  print_error("\r\033[K{}", line.substr(0, terminal_width(STDERR_FILENO) - 1));
  std::fflush(stderr);
}

namespace {

void print_plan(const Sweep& sweep, const std::vector<Cell>& planned) {
  for (const Cell& cell : planned) {
    const std::string repeat = cell.repeat > 0 ? fmt::format(" (repeat {})", cell.repeat) : "";
    fmt::print("{:5}  {}{} / {}\n",
               cell.index,
               printable(sweep.datasets[cell.dataset].label),
               repeat,
               printable(sweep.methods[cell.method].label));
  }
  fmt::print(
      "{}, {} each\n", counted(planned.size(), "cell"), counted(sweep.metrics.size(), "metric"));
}

}  // namespace

void require_parts(const Sweep& sweep, const std::vector<Cell>& cells, const Catalogue& catalogue) {
  for (const Cell& cell : cells) {
    const DatasetChoice& choice = sweep.datasets[cell.dataset];
    const DatasetEntry& entry = find_dataset(catalogue, choice.dataset.name);
    if (!entry.missing_part.empty()) throw MissingPart(choice.label + ": " + entry.missing_part);
  }
}

int dry_run(const Sweep& sweep,
            const std::vector<Cell>& cells,
            const Catalogue& catalogue,
            const DataRoot& root) {
  print_plan(sweep, cells);
  try {
    require_parts(sweep, cells, catalogue);
  } catch (const MissingPart& missing) {  // the inputs can be checked without it
    print_error("loopbench: this build cannot run it: {}\n", missing.what());
  }
  const std::unique_ptr<const ScratchFolder> scratch = scratch_for_programs(sweep);
  const std::vector<std::string> reasons = bad_inputs(sweep, cells, catalogue, root);
  if (reasons.empty()) return kExitOk;
  for (const std::string& reason : reasons) print_error("loopbench: {}\n", printable(reason));
  print_error("loopbench: {} of the sequences above cannot be loaded; their cells would fail\n",
              reasons.size());
  return kExitBadInput;
}

std::string status_text(const CellCounts& counts, std::size_t planned, const Sweep& sweep) {
  std::string protocols;
  for (const metrics::NamedProtocol& each : sweep.protocols) {
    protocols +=
        fmt::format("{}{} [{}]", protocols.empty() ? "" : ", ", each.label(), each.version);
  }
  const std::string earlier =
      counts.earlier == 0 ? "" : fmt::format(" ({} of them in earlier runs)", counts.earlier);
  return fmt::format(
      "{} of {} cells done{}, {} failed{}; value: {}; protocol: {}",
      counts.done,
      planned,
      earlier,
      counts.failed,
      counts.incomplete == 0 ? "" : fmt::format(", {} incomplete", counts.incomplete),
      sweep.table.value,
      protocols);
}

void report_damage(const Resumed& resumed, const std::filesystem::path& store) {
  if (resumed.damaged.empty()) return;
  print_error(
      "loopbench: {}: damaged cells are recomputed: {}{}\n",
      store.string(),
      printable(resumed.damaged.front()),
      resumed.damaged.size() == 1 ? "" : fmt::format(" and {} more", resumed.damaged.size() - 1));
}

std::vector<OutputFile> table_files(const std::filesystem::path& out) {
  std::vector<OutputFile> files;
  for (const char* const name : {"table.md", "table.csv", "rows.csv", "provenance.json"}) {
    files.push_back({"--out", out / name, FileKind::printed, true});
  }
  return files;
}

void write_tables(const std::filesystem::path& store,
                  const Sweep& sweep,
                  const std::vector<Record>& all,
                  const std::filesystem::path& out) {
  write_result(out / "rows.csv", csv(all));
  std::vector<Record> records = all;
  keep_where(records, sweep.table.where);
  std::vector<Table> tables = pivot(records, sweep.table);
  if (!tables.empty()) {
    tables.front().above = texts(counted_notes(store, sweep.table.where), Severity::decisive);
  }
  const StoreProvenance provenance = read_store_provenance(store);
  const std::string text = markdown(tables) + "\n" + build_summary(provenance.provenance) + "\n";
  write_result(out / "table.md", text + "\n" + provenance_comment(provenance));
  write_result(out / "provenance.json", json(provenance));
  write_result(out / "table.csv", csv(tables));
}

std::string summary_text(const std::filesystem::path& store,
                         std::vector<Record> records,
                         const Sweep& sweep) {
  keep_where(records, sweep.table.where);
  std::set<std::string> stated;
  std::vector<Table> views =
      summary(records, {sweep.baseline, sweep.table.value, sweep.table.show}, &stated);
  if (views.empty()) {
    return reasons_text(records, [](const Record& r) { return r.status != Status::ok; });
  }
  views.front().above = texts(counted_notes(store, sweep.table.where), Severity::decisive);
  std::string out;
  for (const Table& view : views) {
    if (!out.empty()) out += "\n";
    out += prints_to_terminal() ? terminal(view, standard_output_style()) : markdown(view);
  }
  return out + reasons_text(records, [&](const Record& r) {
           return is_failure(r.status) && !stated.contains(r.why);
         });
}

std::string merge_command(const std::filesystem::path& out) {
  const std::string folder = shell_quoted(out.string());
  return program_name() + " merge " + folder + "/shards/* -o " + folder;
}

std::string next_commands(const std::filesystem::path& out) {
  const std::string name = program_name();
  const std::string folder = shell_quoted(out.string());
  const bool has_default_name = out.filename() != "" && out.parent_path() == "results";
  const std::string report =
      has_default_name ? shell_quoted(out.filename().string() + ".html") : "report.html";
  const std::vector<std::pair<std::string, std::string>> lines{
      {name + " table " + folder, "all scores of every sequence"},
      {name + " compare " + folder, "every pair of methods, with tests"},
      {name + " report " + folder + " -o " + report, "tables and charts in one HTML file"}};
  std::size_t wide = 0;
  for (const auto& [command, what] : lines) wide = std::max(wide, width(command));
  std::string text = "next:\n";
  for (const auto& [command, what] : lines) {
    text += "  " + padded(command, wide, true) + "  # " + what + "\n";
  }
  return text;
}

}  // namespace loopbench::harness
