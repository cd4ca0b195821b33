#include "harness/commands/write_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "datasets/core/error.hpp"
#include "harness/answers/notes/counted_notes.hpp"
#include "harness/answers/report/alignment_text.hpp"
#include "harness/answers/tables/store_provenance.hpp"
#include "harness/commands/checks.hpp"
#include "harness/commands/standard_output.hpp"
#include "harness/sweep/process/write_file.hpp"
#include "harness/sweep/run/build.hpp"
#include "harness/sweep/store/read.hpp"
#include "harness/sweep/text/print_error.hpp"

namespace loopbench::harness {

namespace {

bool is_printed(const OutputOptions& output) { return output.file.empty() || is_dash(output.file); }

/// "protocol loopbench [3], aligned by rotation and translation".
std::string alignments_text(const std::map<std::string, std::string>& run) {
  std::string out;
  for (const auto& [protocol, align] : alignments(run)) {
    out += (out.empty() ? "protocol " : "; ") + protocol + ", " + alignment_text(align);
  }
  return out;
}

}  // namespace

ExportFormat OutputOptions::format() const {
  const bool has_terminal = is_printed(*this) && prints_to_terminal();
  return given.value_or(has_terminal ? ExportFormat::terminal : ExportFormat::markdown);
}

void declare(CLI::App& command, OutputOptions& output) {
  const std::map<std::string, ExportFormat> known{{"markdown", ExportFormat::markdown},
                                                  {"terminal", ExportFormat::terminal},
                                                  {"latex", ExportFormat::latex},
                                                  {"csv", ExportFormat::csv},
                                                  {"json", ExportFormat::json}};
  command
      .add_option("--format",
                  output.given,
                  "Output format; default: terminal on a terminal, otherwise markdown")
      ->transform(one_of("format", known));
  writes(command,
         add(command,
             "-o,--out FILE",
             output.file,
             "File to write (-: standard output); for CSV also its provenance"),
         FileKind::printed);
  command.add_flag("--wide",
                   output.latex.wide,
                   "LaTeX tables as wide as the text (174 mm) instead of one column (84 mm)");
  add(command,
      "--caption TEXT",
      output.latex.caption,
      "Caption of LaTeX tables, in LaTeX (default: score, statistic and protocol, which are notes "
      "otherwise)");
  add(command, "--label NAME", output.latex.label, "Label of the LaTeX table, for \\ref");
  command.add_flag("--provenance",
                   output.provenance,
                   "Add config, inputs, seeds and machine to Markdown and LaTeX, as a comment");
}

std::string text(std::vector<Table> tables,
                 const OutputOptions& output,
                 const std::filesystem::path& store,
                 const std::vector<std::string>& rules) {
  if (!tables.empty()) {
    tables.front().above = texts(counted_notes(store, rules), Severity::decisive);
  }
  TerminalStyle style = is_printed(output) ? standard_output_style() : TerminalStyle{};
  if (style.width == 0) style.width = 100;
  const ExportFormat format = output.format();
  const std::string alignment =
      format == ExportFormat::latex ? alignments_text(read_run(store)) : "";
  std::string out;
  LatexOptions paper = output.latex;
  std::size_t written = 0;
  for (Table& table : tables) {
    if (++written > 1 && !paper.label.empty())
      paper.label = output.latex.label + "-" + std::to_string(written);
    out += out.empty() || out.ends_with("\n\n") ? "" : "\n";
    if (!alignment.empty()) table.facts += (table.facts.empty() ? "" : "; ") + alignment;
    if (format == ExportFormat::latex) {
      out += latex(table, paper);
    } else if (format == ExportFormat::terminal) {
      out += terminal(with_common_unit(without_empty_columns(table)), style);
    } else {
      out += markdown(table);
    }
  }
  return out;
}

void write_output(const std::string& text,
                  const OutputOptions& output,
                  const std::string& key,
                  const std::filesystem::path& store) {
  const ExportFormat format = output.format();
  if (format != ExportFormat::latex && !(output.latex.caption + output.latex.label).empty()) {
    throw InputError("--caption and --label: need --format latex");
  }
  std::string out = text;
  const StoreProvenance provenance = read_store_provenance(store);
  const std::string summary = build_summary(provenance.provenance);
  const auto sweep = provenance.run.find("sweep");
  const std::string source =
      "source: " + (sweep == provenance.run.end() ? "" : one_line(sweep->second) + ", ") + summary;
  if (format == ExportFormat::json) {
    out = with_provenance(provenance, key, text);
  } else if (format == ExportFormat::terminal) {
    out += "\n" + (is_printed(output) ? fitted(summary) : summary) + "\n";
  } else if (format == ExportFormat::markdown) {
    out +=
        "\n" + (output.provenance ? provenance_comment(provenance) : "<!-- " + source + " -->\n");
  } else if (format == ExportFormat::latex) {
    out += output.provenance ? provenance_lines(provenance, "% ") : "% " + source + "\n";
  }
  if (is_printed(output)) {
    fmt::print("{}", out);
  } else {
    if (format == ExportFormat::csv) require_writable({provenance_output(output.file)});
    write_file(output.file, out);
  }
  if (format == ExportFormat::csv) write_provenance_of_csv(provenance, output.file);
}

OutputFile provenance_output(const std::string& csv) {
  const bool is_printed = csv.empty() || is_dash(csv);
  return {"--out", is_printed ? "" : provenance_file(csv), FileKind::printed, true};
}

void write_provenance_of_csv(const StoreProvenance& provenance, const std::string& file) {
  // Standard output has no folder for a second file.
  if (!file.empty() && !is_dash(file) && std::filesystem::is_regular_file(file))
    return write_result(provenance_file(file), json(provenance));
  print_error(
      "loopbench: {}\nloopbench: with -o FILE, the provenance is written next to the file\n",
      build_summary(provenance.provenance));
}

}  // namespace loopbench::harness
