/// Output of results to a file or to standard output, with their provenance.
#pragma once

#include <filesystem>
#include <future>
#include <string>

#include "harness/tables/store_provenance.hpp"

namespace loopbench::harness {

enum class ExportFormat { markdown, terminal, latex, csv, json };

/// Reads the provenance on another thread while the output is computed.
std::future<StoreProvenance> begin_provenance(const std::filesystem::path& store);

/// Writes `text` to `file`, or prints it if `file` is empty or "-". The provenance of the store is
/// an HTML comment in Markdown, % comments in LaTeX (both omitted on a terminal), and {provenance,
/// KEY: text} in JSON. CSV has no comments: the provenance of `x.csv` is written to
/// `x.provenance.json` next to it; for a printed CSV, one line goes to standard error. Throws
/// InputError.
void write_output(const std::string& text,
                  ExportFormat format,
                  const std::string& key,
                  std::future<StoreProvenance> provenance,
                  const std::filesystem::path& store,
                  const std::string& file);

/// Writes the provenance of a CSV file next to it; see write_output().
void write_provenance_of_csv(const StoreProvenance& provenance, const std::string& file);

}  // namespace loopbench::harness
