#include "datasets/formats/csv.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

#include "datasets/formats/columns.hpp"
#include "datasets/formats/euroc.hpp"
#include "datasets/formats/parts.hpp"
#include "datasets/formats/pose_rules.hpp"
#include "datasets/formats/stamps.hpp"

namespace loopbench {
namespace {

constexpr std::array kCsvNames{"time", "x", "y", "z", "qw", "qx", "qy", "qz"};

std::vector<std::string> header_names(const std::string& header) {
  const char* const separators = header.find(',') == header.npos ? " \t" : ",";
  std::vector<std::string> out;
  std::size_t at = 0;
  while ((at = header.find_first_not_of(separators, at)) != header.npos) {
    const std::size_t end = std::min(header.find_first_of(separators, at), header.size());
    out.push_back(header.substr(at, end - at));
    at = end;
  }
  return out;
}

/// Lower case, without units in brackets and without punctuation: "p_x [m]" -> "px".
std::string plain_name(const std::string& name) {
  std::string out;
  for (const char c : name.substr(0, name.find_first_of("[("))) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0) out += static_cast<char>(std::tolower(letter));
  }
  return out;
}

bool is_one_of(const std::string& name, const std::vector<std::string>& known) {
  return std::ranges::count(known, name) > 0;
}

bool is_time(const std::string& name) {
  return is_one_of(name,
                   {"t",
                    "time",
                    "times",
                    "stamp",
                    "timestamp",
                    "timestamps",
                    "s",
                    "sec",
                    "secs",
                    "seconds",
                    "ns",
                    "nsec",
                    "nanosec",
                    "nanoseconds",
                    "timens",
                    "timestampns",
                    "headerstamp"});
}

/// Column index within kCsvNames; nothing for other columns.
std::optional<std::size_t> meaning(const std::string& name) {
  if (is_time(name)) return 0;
  if (name.empty()) return std::nullopt;
  const std::string axis = name.substr(name.size() - 1);
  const std::string stem = name.substr(0, name.size() - 1);
  const auto ends = [&](const char* with) { return stem.ends_with(with); };
  const std::size_t index = std::string("xyz").find(axis);
  if (axis == "w" || index != std::string::npos) {
    if (is_one_of(stem, {"q", "quat", "quaternion", "rot", "qrs"}) || ends("orientation") ||
        ends("rotation")) {
      return axis == "w" ? 4 : 5 + index;
    }
  }
  if (index != std::string::npos && (is_one_of(stem, {"", "t", "p", "pos", "prsr", "trans"}) ||
                                     ends("position") || ends("translation"))) {
    return 1 + index;
  }
  return std::nullopt;
}

Trajectory read_csv_part(TextFile& file, const CsvColumns& columns, const ReadOptions& options) {
  Trajectory out;
  StampOrder order(file, options.repeats);
  std::vector<std::string_view> row;
  std::array<double, kCsvNames.size()> v{};
  for (Line line; file.next(line);) {
    row.clear();
    for (Columns each(file, line); !each.done();) row.push_back(each.word());
    if (row.size() != columns.width) {
      throw wrong_columns(
          file, line, Format::csv, std::to_string(columns.width) + " as in the header");
    }
    for (std::size_t i = 0; i < v.size(); ++i) {
      Line column = line;
      column.text = row[columns.index[i]];
      v[i] = Columns(file, column).number(kCsvNames[i]);
    }
    const double stamp = seconds_of_stamp(row[columns.index[0]], v[0], columns.nanoseconds);
    const Rotation rotation = normalized_rotation(file, line.number, {v[4], v[5], v[6], v[7]});
    order.put(stamp, line.number, {rotation, {v[1], v[2], v[3]}}, out);
  }
  return out;
}

}  // namespace

std::optional<CsvColumns> csv_columns(const std::string& header) {
  const std::vector<std::string> names = header_names(header);
  CsvColumns out;
  out.width = names.size();
  std::array<bool, kCsvNames.size()> found{};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto column = meaning(plain_name(names[i]));
    if (!column) continue;
    if (found[*column]) return std::nullopt;
    found[*column] = true;
    out.index[*column] = i;
    if (*column == 0) {
      out.nanoseconds = names[i].find("[ns]") != std::string::npos ||
                        plain_name(names[i]).find("nano") != std::string::npos ||
                        plain_name(names[i]).ends_with("ns");
    }
  }
  if (!std::ranges::all_of(found, [](bool is) { return is; })) return std::nullopt;
  return out;
}

Trajectory read_csv(TextFile& file, const ReadOptions& options) {
  const auto columns = csv_columns(file.header());
  if (!columns) {
    throw file.error(0,
                     "has no header that names time, x, y, z, qx, qy, qz and qw, expected one in a "
                     "csv file");
  }
  return joined(read_parallel(
      file,
      [&](TextFile& part) { return read_csv_part(part, *columns, options); },
      [](const Trajectory& a, const Trajectory& b) {
        return !a.empty() && !b.empty() && a.back().stamp < b.front().stamp;
      }));
}

}  // namespace loopbench
