#include <algorithm>

#include "harness/answers/report/sections.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

/// Without control characters, except newlines, and with valid UTF-8 only.
std::string printable_text(std::string_view text) {
  std::string out(text);
  std::ranges::replace(out, '\t', ' ');
  std::erase_if(out, [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\n'; });
  return printable(out);
}

std::string notes_list(const std::vector<std::string>& notes) {
  if (notes.empty()) return "";
  std::string out = "<ul class=\"notes\">";
  for (const std::string& note : notes) out += "<li>" + html_text(note) + "</li>";
  return out + "</ul>";
}

std::string lines_of(const Table& table) {
  std::string out;
  for (const std::vector<TableCell>& line : table.lines) {
    out += "<tr>";
    for (std::size_t c = 0; c < line.size(); ++c) {
      const std::string text = html_text(line[c].text);
      if (c == 0) {
        out += "<th scope=\"row\">" + text + "</th>";
      } else {
        out += (line[c].is_best ? "<td class=\"best\">" : "<td>") + text + "</td>";
      }
    }
    out += "</tr>\n";
  }
  return out;
}

std::string figure(const Table& all, const std::string& attributes) {
  if (all.headings.empty()) return notes_list(note_texts(all));
  const Table table = without_empty_columns(all);
  const std::string title = html_text(table.title);
  std::string out = "<figure " + attributes +
                    "><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" + title +
                    "\"><table><caption>" + title + "</caption><thead><tr>";
  for (const std::string& heading : table.headings) {
    out += "<th scope=\"col\">" + html_text(heading) + "</th>";
  }
  return out + "</tr></thead><tbody>\n" + lines_of(table) + "</tbody></table></div>" +
         notes_list(note_texts(table)) + "</figure>\n";
}

}  // namespace

std::string html_text(std::string_view text) {
  std::string out;
  for (const char c : printable_text(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string script_text(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) c == '<' ? out += "\\u003c" : out += c;  // only in strings
  return out;
}

std::string html_table(const Table& table, const std::string& attributes) {
  return figure(table, "class=\"table\"" + (attributes.empty() ? "" : " " + attributes));
}

std::string html_text_table(const Table& table) { return figure(table, "class=\"table texts\""); }

}  // namespace loopbench::harness
