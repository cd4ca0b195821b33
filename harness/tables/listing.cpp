#include "harness/tables/listing.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/tables/text.hpp"

namespace loopbench::harness {
namespace {

std::string escaped_cell(const std::string& text) {
  std::string out;
  for (const char c : one_line(text)) {
    if (c == '|') out += '\\';
    out += c;
  }
  return out;
}

}  // namespace

std::string markdown(const TextTable& listing) {
  std::vector<std::size_t> widths;
  for (const std::string& column : listing.columns) {
    widths.push_back(std::max<std::size_t>(2, escaped_cell(column).size()));  // a dash and a colon
  }
  for (const auto& row : listing.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      widths[c] = std::max(widths[c], escaped_cell(row[c]).size());
    }
  }
  const auto line = [&](const std::vector<std::string>& texts) {
    std::string out = "|";
    for (std::size_t c = 0; c < texts.size(); ++c) {
      out += c == 0 ? fmt::format(" {:<{}} |", escaped_cell(texts[c]), widths[c])
                    : fmt::format(" {:>{}} |", escaped_cell(texts[c]), widths[c]);
    }
    return out + "\n";
  };
  std::string out = "### " + one_line(listing.title) + "\n\n" + line(listing.columns) + "|";
  for (std::size_t c = 0; c < widths.size(); ++c) {
    out += c == 0 ? fmt::format(" {:-<{}} |", "", widths[c])
                  : fmt::format(" {:-<{}}: |", "", widths[c] - 1);
  }
  out += "\n";
  for (const auto& row : listing.rows) out += line(row);
  if (!listing.notes.empty()) out += "\n";
  for (const std::string& note : listing.notes) out += "- " + one_line(note) + "\n";
  return out;
}

TableView table_view(const TextTable& listing) {
  TableView out{listing.title, listing.columns, {}, listing.notes};
  for (const std::vector<std::string>& row : listing.rows) {
    std::vector<TableViewEntry>& line = out.lines.emplace_back();
    for (const std::string& text : row) line.push_back({text});
  }
  return out;
}

std::string csv(const TextTable& listing) {
  std::string out = "table";
  for (const std::string& column : listing.columns) out += "," + quoted(column);
  out += "\n";
  for (const auto& row : listing.rows) {
    out += quoted(listing.title);
    for (const std::string& text : row) out += "," + quoted(text);
    out += "\n";
  }
  return out;
}

}  // namespace loopbench::harness
