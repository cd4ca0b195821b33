#include "harness/commands/deliver.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "harness/provenance/made_by.hpp"
#include "harness/store/open.hpp"
#include "harness/tables/origin.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {

void deliver(const std::string& text,
             ExportFormat format,
             const std::string& key,
             const std::filesystem::path& store,
             const std::string& file) {
  const bool is_printed = file.empty() || is_dash(file);
  const bool is_read_by_a_person = is_printed && isatty(STDOUT_FILENO) == 1;
  std::string out = text;
  const Origin origin = read_origin(store);
  if (format == ExportFormat::json) {
    out = with_origin(origin, key, text);
  } else if (format == ExportFormat::terminal) {
    out += "\n" + made_by(origin.provenance) + "\n";
  } else if (format == ExportFormat::markdown && !is_read_by_a_person) {
    out += "\n" + origin_comment(origin);
  } else if (format == ExportFormat::latex && !is_read_by_a_person) {
    out += origin_lines(origin, "% ");
  }
  if (is_printed) {
    fmt::print("{}", out);
  } else {
    refuse_to_overwrite({store_file(store)}, file);
    write_file(file, out);
  }
  if (format != ExportFormat::csv) return;
  // Standard output has no file beside it.
  if (!is_printed && std::filesystem::is_regular_file(file))
    return write_file(origin_file(file), json(origin));
  fmt::print(stderr,
             "loopbench: {}\nloopbench: with -o FILE, the provenance is written beside the file\n",
             made_by(origin.provenance));
}

}  // namespace loopbench::harness
