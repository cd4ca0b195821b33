#include "harness/commands/write_output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "harness/commands/standard_output.hpp"
#include "harness/provenance/build_summary.hpp"
#include "harness/store/open.hpp"
#include "harness/tables/store_provenance.hpp"
#include "harness/text/print_error.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {

std::future<StoreProvenance> begin_provenance(const std::filesystem::path& store) {
  return std::async(std::launch::async, read_store_provenance, store);
}

void write_output(const std::string& text,
                  ExportFormat format,
                  const std::string& key,
                  std::future<StoreProvenance> begun,
                  const std::filesystem::path& store,
                  const std::string& file) {
  const bool is_printed = file.empty() || is_dash(file);
  const bool is_read_by_a_person = is_printed && isatty(STDOUT_FILENO) == 1;
  std::string out = text;
  const StoreProvenance provenance = begun.get();
  if (format == ExportFormat::json) {
    out = with_provenance(provenance, key, text);
  } else if (format == ExportFormat::terminal) {
    const std::string summary = build_summary(provenance.provenance);
    out += "\n" + (is_printed ? fitted(summary) : summary) + "\n";
  } else if (format == ExportFormat::markdown && !is_read_by_a_person) {
    out += "\n" + provenance_comment(provenance);
  } else if (format == ExportFormat::latex && !is_read_by_a_person) {
    out += provenance_lines(provenance, "% ");
  }
  if (is_printed) {
    fmt::print("{}", out);
  } else {
    reject_overwriting({store_file(store)}, file);
    write_file(file, out);
  }
  if (format == ExportFormat::csv) write_provenance_of_csv(provenance, file);
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
