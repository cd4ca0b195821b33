#include "harness/eval/eval_report.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "harness/eval/error_figures.hpp"
#include "harness/report/html.hpp"
#include "harness/text/write_file.hpp"

namespace loopbench::harness {
namespace {

std::string base64_of(const std::string& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) {
      group = (group << 8) | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= count ? kDigits[(group >> (18 - 6 * k)) & 63u] : '=';
    }
  }
  return out;
}

/// The lines of a text, escaped one by one: html_text() drops line breaks.
std::string html_lines(const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) out += html_text(line) + "\n";
  return out;
}

/// The figure as SVG text, through a temporary file next to the page.
std::string svg_of(const NamedFigure& figure,
                   const std::string& note,
                   const std::filesystem::path& page) {
  const std::filesystem::path file =
      page.string() + fmt::format(".{}.{}.svg", getpid(), figure.name);
  write_figure(file, figure.panels, figure.columns, {4.5, 3.6, 11.0, true, note});
  std::string text;
  {
    std::ifstream in(file, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  std::filesystem::remove(file);
  return text;
}

}  // namespace

void write_eval_report(const std::filesystem::path& file,
                       const std::string& reference,
                       const std::vector<Table>& tables,
                       const std::string& text,
                       const std::vector<DrawnRuns>& drawn) {
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
  for (const DrawnRuns& each : drawn) {
    for (const NamedFigure& figure : error_figures(each.drawn)) {
      page +=
          fmt::format("<h2>{0}</h2>\n<img alt=\"{0}\" src=\"data:image/svg+xml;base64,{1}\">\n",
                      html_text(each.sequence + (each.sequence.empty() ? "" : ": ") + figure.name),
                      base64_of(svg_of(figure, each.note, file)));
    }
  }
  write_file(file, page + "</body>\n</html>\n");
}

}  // namespace loopbench::harness
