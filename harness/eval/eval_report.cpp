#include "harness/eval/eval_report.hpp"

#include <fmt/format.h>

#include <sstream>

#include "harness/base/write_file.hpp"
#include "harness/report/html.hpp"
#include "harness/report/packed.hpp"

namespace loopbench::harness {
namespace {

/// The lines of a text, escaped one by one: html_text() drops line breaks.
std::string html_lines(const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) out += html_text(line) + "\n";
  return out;
}

}  // namespace

void write_eval_report(const std::filesystem::path& file,
                       const std::string& reference,
                       const std::vector<Table>& tables,
                       const std::string& text,
                       const std::vector<PageImage>& images) {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0} - loopbench eval</title>\n"
      "<style>body{{font-family:sans-serif;margin:2rem;max-width:90rem}}"
      "pre{{overflow-x:auto;background:#f5f5f5;padding:1rem}}img{{max-width:100%}}"
      "figure{{margin:0 0 1rem}}.scroll{{overflow-x:auto}}table{{border-collapse:collapse}}"
      "caption{{text-align:left;font-weight:bold;padding:.5rem 0}}"
      "th,td{{padding:.3rem .6rem;border-bottom:1px solid #ddd;text-align:right}}"
      "th[scope=row]{{text-align:left}}.notes{{font-size:.9em}}</style>\n"
      "</head>\n<body>\n<h1>Evaluation against {0}</h1>\n",
      html_text(reference));
  for (const Table& table : tables) page += html_table(table_view(table));
  if (!text.empty()) page += "<pre>" + html_lines(text) + "</pre>\n";
  for (const PageImage& image : images) {
    page += fmt::format("<h2>{0}</h2>\n<img alt=\"{0}\" src=\"data:image/svg+xml;base64,{1}\">\n",
                        html_text(image.heading),
                        base64(image.svg));
  }
  write_file(file, page + "</body>\n</html>\n");
}

}  // namespace loopbench::harness
