#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "datasets/columns/stamps.hpp"
#include "datasets/compressed/input_file.hpp"
#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/json_graph.hpp"
#include "datasets/formats/matrix_list.hpp"

namespace loopbench {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLargestJson = std::size_t{1} << 30;  // [bytes]

/// Whether the file begins as an object or a list.
bool is_json(const std::filesystem::path& file) {
  if (is_json_graph(file)) return false;
  const OpenedFile in = open_input(file);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> handle(std::fopen(in.path.c_str(), "rb"),
                                                               std::fclose);
  std::array<char, 64> start{};
  const std::size_t count =
      handle ? std::fread(start.data(), 1, start.size(), handle.get()) : std::size_t{0};
  const std::string_view text(start.data(), count);
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == text.npos || (text[first] != '{' && text[first] != '[')) return false;
  // A line such as "[t, x, y, z]" names columns of a table.
  const std::size_t next = text.find_first_not_of(kBlanks, first + 1);
  return next != text.npos && std::string_view("\"[{]}").find(text[next]) != text.npos;
}

/// The numbers of a list, also of lists in it to that depth, in order.
void add_numbers(const Json& value, std::vector<double>& out, int depth = 2) {
  if (value.is_number()) {
    out.push_back(value.get<double>());
  } else if (value.is_null()) {
    out.push_back(std::nan(""));
  } else if (value.is_array() && depth > 0) {
    for (const Json& each : value) add_numbers(each, out, depth - 1);
  }
}

/// A 3 x 4 or 4 x 4 matrix by rows; nothing for other values.
std::optional<PoseMatrix> matrix_in(const Json& value) {
  std::vector<double> v;
  if (value.is_array()) add_numbers(value, v);
  if (v.size() == 16 && (v[12] != 0.0 || v[13] != 0.0 || v[14] != 0.0)) return std::nullopt;
  if (v.size() != 12 && v.size() != 16) return std::nullopt;
  PoseMatrix out;
  out.matrix() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(v.data());
  return out;
}

/// The value of the first of these keys; null: none.
const Json* value_of(const Json& object, std::initializer_list<const char*> keys) {
  if (!object.is_object()) return nullptr;
  for (const char* const key : keys) {
    if (const auto found = object.find(key); found != object.end()) return &*found;
  }
  return nullptr;
}

/// Names in the order of the numbers in them: frame_2 before frame_10.
bool is_before(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return '0' <= c && c <= '9'; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!digit(a[i]) || !digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    while (i < a.size() && a[i] == '0') ++i;
    while (j < b.size() && b[j] == '0') ++j;
    std::size_t k = i, l = j;
    while (k < a.size() && digit(a[k])) ++k;
    while (l < b.size() && digit(b[l])) ++l;
    if (k - i != l - j) return k - i < l - j;
    const int order = a.compare(i, k - i, b, j, l - j);
    if (order != 0) return order < 0;
    i = k, j = l;
  }
  return a.size() - i < b.size() - j;
}

struct JsonFrame {
  PoseMatrix pose;
  std::string image;
  std::optional<double> stamp;
};

[[noreturn]] void reject_layout(const std::string& name, const std::string& found) {
  throw input_error(
      name,
      0,
      "is JSON with " + found +
          ", expected transforms.json of NeRF (frames with transform_matrix) or a list of 4 x 4 "
          "matrices; for a list of objects with t, x, y, z and a quaternion: jq -r '.[] | [.t, .x, "
          ".y, .z, .qx, .qy, .qz, .qw] | @tsv' " +
          name + " > poses.txt");
}

std::vector<JsonFrame> frames_in(const Json& list, const std::string& name) {
  std::vector<JsonFrame> out;
  for (const Json& each : list) {
    JsonFrame& frame = out.emplace_back();
    const Json* const matrix =
        each.is_object()
            ? value_of(each, {"transform_matrix", "matrix", "pose", "transform", "c2w", "T"})
            : &each;
    const auto pose = matrix != nullptr ? matrix_in(*matrix) : std::nullopt;
    if (!pose) {
      reject_layout(name, "entry " + std::to_string(out.size() - 1) + " without a matrix");
    }
    frame.pose = *pose;
    const Json* const image = value_of(each, {"file_path", "image", "filename"});
    if (image != nullptr && image->is_string()) frame.image = image->get<std::string>();
    const Json* const stamp = value_of(each, {"timestamp", "stamp", "time", "t"});
    if (stamp != nullptr && stamp->is_number()) frame.stamp = stamp->get<double>();
  }
  return out;
}

/// Numbers of rows, or stamps if all frames have one. Frames with images are in their order.
std::vector<ListedMatrix> in_order(std::vector<JsonFrame> frames, ReadFindings& findings) {
  const auto all = [&](auto has) { return std::ranges::all_of(frames, has); };
  const bool has_stamps = all([](const JsonFrame& f) { return f.stamp.has_value(); });
  const bool has_images = all([](const JsonFrame& f) { return !f.image.empty(); });
  const auto before = [&](const JsonFrame& a, const JsonFrame& b) {
    return has_stamps ? *a.stamp < *b.stamp : is_before(a.image, b.image);
  };
  if (has_stamps || has_images) {
    for (std::size_t i = 1; i < frames.size(); ++i) {
      findings.unsorted += before(frames[i], frames[i - 1]) ? 1 : 0;
    }
    std::ranges::stable_sort(frames, before);
  }
  findings.clock = has_stamps ? Clock::stamps : Clock::rows;
  std::vector<ListedMatrix> out;
  for (const JsonFrame& frame : frames) {
    const auto row = static_cast<double>(out.size());
    out.push_back({frame.image.empty() ? "entry " + std::to_string(out.size()) : frame.image,
                   frame.pose,
                   has_stamps ? *frame.stamp : row});
  }
  return out;
}

TrajectoryFile read_json(const std::filesystem::path& file, const ReadOptions& options) {
  const std::string name = file.string();
  const Json json = Json::parse(read_named_file(file, kLargestJson, "a JSON file"), nullptr, false);
  if (json.is_discarded()) throw input_error(name, 0, "is not valid JSON");
  const Json* const listed = value_of(json, {"frames", "poses", "trajectory"});
  const Json& list = listed != nullptr ? *listed : json;
  if (!list.is_array() || list.empty()) reject_layout(name, "no list of poses");
  std::vector<JsonFrame> frames = frames_in(list, name);
  ReadFindings findings;
  findings.opengl_axes = value_of(list.front(), {"transform_matrix"}) != nullptr;
  if (findings.opengl_axes) {
    const Eigen::DiagonalMatrix<double, 3> opengl_from_opencv(1.0, -1.0, -1.0);
    for (JsonFrame& frame : frames) frame.pose.linear() = frame.pose.linear() * opengl_from_opencv;
  }
  const std::vector<ListedMatrix> matrices = in_order(std::move(frames), findings);
  TrajectoryFile out = poses_of_matrices(name, matrices, options, std::move(findings));
  out.format = Format::json;
  return out;
}

}  // namespace

FormatEntry json_format() {
  return {.format = Format::json, .guess_file = is_json, .read_file = read_json};
}

}  // namespace loopbench
