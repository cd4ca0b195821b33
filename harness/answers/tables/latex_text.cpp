#include "harness/answers/tables/latex_text.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

#include "harness/answers/tables/table.hpp"

namespace loopbench::harness {

std::string escaped_latex(const std::string& text) {
  static const std::map<char, std::string> kEscaped{
      {'\\', "\\textbackslash{}"},
      {'~', "\\textasciitilde{}"},
      {'^', "\\textasciicircum{}"},
      {'<', "\\textless{}"},
      {'>', "\\textgreater{}"},
      {'|', "\\textbar{}"},
      {'"', "\\char34{}"},
      {'[', "{[}"},  // else a length after a line break
      {'-', "{-}"},  // else -- is a dash
      {'&', "\\&"},
      {'%', "\\%"},
      {'$', "\\$"},
      {'#', "\\#"},
      {'_', "\\_"},
      {'{', "\\{"},
      {'}', "\\}"}};
  std::string out;
  for (const char c : one_line(text)) {
    const auto found = kEscaped.find(c);
    out += found == kEscaped.end() ? std::string(1, c) : found->second;
  }
  static const std::pair<std::string, std::string> kSymbols[] = {{"\u00b1", "$\\pm$"},
                                                                 {kDagger, "$^\\dagger$"}};
  for (const auto& [symbol, command] : kSymbols) {
    for (std::size_t at = 0; (at = out.find(symbol, at)) != std::string::npos;) {
      out.replace(at, symbol.size(), command);
    }
  }
  return out;
}

std::string breakable(const std::string& text) {
  std::string out, part;
  for (std::size_t i = 0; i < text.size(); ++i) {
    part += text[i];
    const bool is_break = std::string_view("_/=").find(text[i]) != std::string_view::npos;
    if (!is_break && i + 1 < text.size()) continue;
    out += escaped_latex(part) + (is_break ? "\\allowbreak{}" : "");
    part.clear();
  }
  return out;
}

double latex_width(const std::string& text) {
  static constexpr std::pair<std::string_view, double> kWidths[] = {
      {"ijl.,:;'!|", 2.4},
      {"rtfs()[]- ", 3.4},
      {"0123456789", 4.3},
      {"mwMW%+=<>@\xc2", 7.1},
      {"ABCDEFGHIJKLNOPQRSTUVXYZ", 6.4}};
  double out = 0.0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xc0) == 0x80) continue;  // continues a character
    const auto found = std::ranges::find_if(
        kWidths, [c](const auto& each) { return each.first.find(c) != std::string_view::npos; });
    out += found == std::end(kWidths) ? 4.8 : found->second;
  }
  return out;
}

}  // namespace loopbench::harness
