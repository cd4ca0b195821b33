/// Output of results to a file or to standard output, with their provenance.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/answers/tables/store_provenance.hpp"
#include "harness/answers/tables/table.hpp"
#include "harness/commands/output_files.hpp"

namespace loopbench::harness {

enum class ExportFormat { markdown, terminal, latex, csv, json };

/// Options of commands that print tables.
struct OutputOptions {
  std::optional<ExportFormat> given;  ///< none: terminal on a terminal, otherwise Markdown
  std::string file;                   ///< empty or "-": standard output
  bool provenance = false;            ///< all provenance in Markdown and LaTeX, not one line
  LatexOptions latex = {};            ///< of LaTeX only

  ExportFormat format() const;
};

/// Adds --format, --wide, --provenance, and -o.
void declare(CLI::App& command, OutputOptions& output);

/// The tables of a store one below the other: Markdown, LaTeX with the alignment in the captions,
/// or for the terminal in its width. Above them, the notes that can change a conclusion, of the
/// runs that pass the filters `rules`.
std::string text(std::vector<Table> tables,
                 const OutputOptions& output,
                 const std::filesystem::path& store,
                 const std::vector<std::string>& rules = {});

/// Writes or prints `text`. A comment in Markdown and LaTeX names the source in one line, or has
/// the provenance of the store if requested; JSON is {provenance, KEY: text}. CSV has no comments:
/// the provenance of `x.csv` is written to `x.provenance.json` next to it; for a printed CSV, one
/// line goes to standard error. Throws InputError.
void write_output(const std::string& text,
                  const OutputOptions& output,
                  const std::string& key,
                  const std::filesystem::path& store);

/// The file of the provenance of a CSV file.
OutputFile provenance_output(const std::string& csv);

/// Writes the provenance of a CSV file next to it; see write_output().
void write_provenance_of_csv(const StoreProvenance& provenance, const std::string& file);

}  // namespace loopbench::harness
