/// Results on their way out: printed or written, with what made them.
#pragma once

#include <filesystem>
#include <string>

namespace loopbench {

enum class ExportFormat { markdown, terminal, latex, csv, json };

/// Writes `text` to `file`, or prints it when `file` is empty or "-". Markdown carries the origin
/// of the store's numbers in an HTML comment and LaTeX in % comments (not on a terminal, where a
/// person reads), JSON as {provenance, KEY: text}. A CSV with comments is none: the origin of
/// `x.csv` is written beside it, as `x.provenance.json`; of a printed one a line goes to standard
/// error. Throws InputError.
void deliver(const std::string& text,
             ExportFormat format,
             const std::string& key,
             const std::filesystem::path& store,
             const std::string& file);

}  // namespace loopbench
