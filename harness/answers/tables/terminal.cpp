#include <algorithm>
#include <utility>

#include "harness/answers/tables/table.hpp"
#include "harness/sweep/text/wrap.hpp"

namespace loopbench::harness {
namespace {

using Lines = std::vector<std::string>;

constexpr std::size_t kGap = 2;  ///< spaces between columns

/// One column of a table as printed: its heading in lines, and one text per row.
struct PrintedColumn {
  Lines heading;
  Lines entries;
  std::vector<bool> is_best;
  std::size_t wide = 3;
  bool has_mark_column = false;  ///< the last character of its lines is for marks
};

std::size_t widest(const Lines& texts, std::size_t least) {
  for (const std::string& text : texts) least = std::max(least, width(text));
  return least;
}

std::vector<PrintedColumn> columns_of(const Table& table) {
  std::vector<PrintedColumn> out;
  for (std::size_t c = 0; c < table.headings.size(); ++c) {
    PrintedColumn& column = out.emplace_back();
    column.heading = {one_line(table.headings[c])};
    bool has_mark = false;
    for (const auto& line : table.lines) has_mark = has_mark || line[c].is_best;
    for (const auto& line : table.lines) {
      // The mark has its own column, so that digits are aligned.
      const char* const no_sign = has_mark && c > 0 ? " " : "";
      const char* const sign = line[c].is_best ? "*" : no_sign;
      column.entries.push_back(one_line(line[c].text) + sign);
      column.is_best.push_back(line[c].is_best);
    }
    column.has_mark_column = has_mark && c > 0;
    if (column.has_mark_column) column.heading[0] += " ";
    column.wide = widest(column.entries, widest(column.heading, 3));
  }
  return out;
}

std::size_t total_width(const std::vector<PrintedColumn>& columns) {
  std::size_t out = 0;
  for (const PrintedColumn& column : columns) out += (out == 0 ? 0 : kGap) + column.wide;
  return out;
}

/// Breaks headings that are wider than the entries below them and than `narrowest`.
void break_headings(std::vector<PrintedColumn>& columns, std::size_t narrowest) {
  for (PrintedColumn& column : columns) {
    const std::size_t body = widest(column.entries, 3);
    std::string heading;
    for (const std::string& line : column.heading) heading += (heading.empty() ? "" : " ") + line;
    Lines lines = wrapped(heading, std::max(body, narrowest));
    for (std::string& line : lines) {
      while (line.ends_with(' ')) line.pop_back();
      if (column.has_mark_column) line += ' ';
    }
    column.heading = lines;
    column.wide = widest(lines, body);
  }
}

void shorten_names(PrintedColumn& names, std::size_t columns) {
  for (std::string& name : names.entries) name = shortened(name, columns);
  for (std::string& line : names.heading) line = shortened(line, columns);
  names.wide = widest(names.entries, widest(names.heading, 3));
}

/// Indices of the columns of each block; every block starts with the names.
std::vector<std::vector<std::size_t>> blocks(const std::vector<PrintedColumn>& columns,
                                             std::size_t limit) {
  std::vector<std::vector<std::size_t>> out{{0}};
  std::size_t used = columns[0].wide;
  for (std::size_t c = 1; c < columns.size(); ++c) {
    if (limit > 0 && used + kGap + columns[c].wide > limit && out.back().size() > 1) {
      out.push_back({0});
      used = columns[0].wide;
    }
    out.back().push_back(c);
    used += kGap + columns[c].wide;
  }
  return out;
}

std::string highlighted(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' ');
  return text.substr(0, begin) + "\033[1;32m" + text.substr(begin) + "\033[0m";
}

void add_line(std::string& out, std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  out += line + "\n";
}

std::string block_text(const std::vector<PrintedColumn>& columns,
                       const std::vector<std::size_t>& shown,
                       bool color) {
  std::string out;
  const std::string gap(kGap, ' ');
  std::size_t heading_lines = 1;
  for (const std::size_t c : shown)
    heading_lines = std::max(heading_lines, columns[c].heading.size());
  for (std::size_t l = 0; l < heading_lines; ++l) {
    std::string line;
    for (const std::size_t c : shown) {
      const Lines& heading = columns[c].heading;
      const std::size_t empty = heading_lines - heading.size();  // headings end at the rule
      line += (c == 0 ? "" : gap) +
              padded(l < empty ? "" : heading[l - empty], columns[c].wide, c == 0);
    }
    add_line(out, line);
  }
  std::string rule;
  for (const std::size_t c : shown) rule += (c == 0 ? "" : gap) + std::string(columns[c].wide, '-');
  add_line(out, rule);
  for (std::size_t r = 0; r < columns[0].entries.size(); ++r) {
    std::string line;
    for (const std::size_t c : shown) {
      const std::string text = padded(columns[c].entries[r], columns[c].wide, c == 0);
      line += (c == 0 ? "" : gap) + (color && columns[c].is_best[r] ? highlighted(text) : text);
    }
    add_line(out, line);
  }
  return out;
}

}  // namespace

std::string terminal(const Table& all, const TerminalStyle& style) {
  const Table table = without_empty_columns(all);
  std::vector<PrintedColumn> columns = columns_of(table);
  const auto is_too_wide = [&] { return style.width > 0 && total_width(columns) > style.width; };
  for (const std::size_t narrowest : {9UL, 4UL}) {
    if (is_too_wide()) break_headings(columns, narrowest);
  }
  if (is_too_wide()) shorten_names(columns[0], std::max<std::size_t>(12, style.width / 2));
  std::string out;
  for (const std::string& sentence : table.above) {
    const std::size_t room = style.width == 0 ? 0 : std::max<std::size_t>(20, style.width - 2);
    const char* begin = "! ";
    for (const std::string& line : wrapped(one_line(sentence), room)) {
      add_line(out, std::exchange(begin, "  ") + line);
    }
  }
  for (const std::string& line : wrapped(one_line(table.title), style.width)) {
    if (!line.empty()) out += style.color ? "\033[1m" + line + "\033[0m\n" : line + "\n";
  }
  const auto parts =
      columns.empty() ? std::vector<std::vector<std::size_t>>() : blocks(columns, style.width);
  for (std::size_t b = 0; b < parts.size(); ++b) {
    out += (b == 0 ? "" : "\n") + block_text(columns, parts[b], style.color);
  }
  for (const std::string& note : note_texts(table)) {
    const Lines lines =
        wrapped(one_line(note), style.width == 0 ? 0 : std::max<std::size_t>(20, style.width - 2));
    for (std::size_t l = 0; l < lines.size(); ++l) add_line(out, (l == 0 ? "" : "  ") + lines[l]);
  }
  return out;
}

}  // namespace loopbench::harness
