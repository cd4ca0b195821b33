#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "datasets/columns/pose_rules.hpp"
#include "datasets/compressed/input_file.hpp"
#include "datasets/core/pose_rule.hpp"
#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/matrix_list.hpp"
#include "datasets/formats/times.hpp"

namespace loopbench {
namespace {

constexpr std::string_view kNpyMagic = "\x93NUMPY";
constexpr std::size_t kLargestNpy = std::size_t{4} << 30;  // [bytes]

bool is_npy(const std::filesystem::path& file) {
  const OpenedFile in = open_input(file);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> handle(std::fopen(in.path.c_str(), "rb"),
                                                               std::fclose);
  std::array<char, kNpyMagic.size()> start{};
  return handle && std::fread(start.data(), 1, start.size(), handle.get()) == start.size() &&
         std::string_view(start.data(), start.size()) == kNpyMagic;
}

/// Numbers of a file of NumPy, by rows.
struct NumpyArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};

/// What follows `key` in the dictionary of the header, up to `end`.
std::string_view header_value(std::string_view header, std::string_view key, char end) {
  const std::size_t at = header.find(key);
  if (at == header.npos) return {};
  header.remove_prefix(std::min(header.find(':', at) + 1, header.size()));
  header.remove_prefix(std::min(header.find_first_not_of(' '), header.size()));
  return header.substr(0, header.find(end));
}

template <class Number>
std::vector<double> numbers_in(std::string_view bytes) {
  std::vector<double> out(bytes.size() / sizeof(Number));
  for (std::size_t i = 0; i < out.size(); ++i) {
    Number value{};
    std::memcpy(&value, bytes.data() + i * sizeof(Number), sizeof(Number));
    out[i] = static_cast<double>(value);
  }
  return out;
}

/// Parses the header, 128 bytes or more with version, length and a dictionary, and the numbers
/// behind it. Objects would be pickles, which can run code, and are rejected. Source:
/// numpy.lib.format.
NumpyArray parse_npy(const std::string& name, std::string_view file) {
  static_assert(std::endian::native == std::endian::little);
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(file[i]); };
  constexpr std::size_t kShortest = 12;
  if (file.size() < kShortest) throw input_error(name, 0, "ends in its header");
  const std::size_t begin = byte(6) == 1 ? 10 : 12;
  std::size_t length = byte(8) + 256U * byte(9);
  if (begin == 12) length += 65536U * byte(10) + 16777216U * byte(11);
  if (file.size() - begin < length) throw input_error(name, 0, "ends in its header");
  const std::string_view header = file.substr(begin, length);
  std::string_view type = header_value(header, "'descr'", ',');
  while (!type.empty() && (type.back() == '\'' || type.back() == ' ')) type.remove_suffix(1);
  if (type.starts_with('\'')) type.remove_prefix(1);
  if (type != "<f8" && type != "<f4") {
    throw input_error(name,
                      0,
                      "has numbers of type '" + std::string(type.substr(0, 40)) +
                          "', expected float64 or float32 (<f8, <f4), no objects");
  }
  if (header_value(header, "'fortran_order'", ',') != "False") {
    throw input_error(name, 0, "is in Fortran order, expected numpy.ascontiguousarray(ARRAY)");
  }
  NumpyArray out;
  std::string_view shape = header_value(header, "'shape'", ')');
  std::size_t count = 1;
  while (!shape.empty()) {
    std::size_t size = 0;
    const std::size_t digit = shape.find_first_of("0123456789");
    if (digit == shape.npos) break;
    shape.remove_prefix(digit);
    const auto [stop, error] = std::from_chars(shape.data(), shape.data() + shape.size(), size);
    if (error != std::errc{} || __builtin_mul_overflow(count, size, &count)) count = file.size();
    out.shape.push_back(size);
    shape.remove_prefix(static_cast<std::size_t>(stop - shape.data()));
  }
  const std::string_view bytes = file.substr(begin + length);
  const std::size_t width = type == "<f8" ? sizeof(double) : sizeof(float);
  if (bytes.size() / width != count || bytes.size() % width != 0) {
    throw input_error(name, 0, "has not the numbers that its header states");
  }
  out.values = width == sizeof(double) ? numbers_in<double>(bytes) : numbers_in<float>(bytes);
  return out;
}

std::vector<ListedMatrix> matrices_of(const NumpyArray& array, std::size_t width) {
  std::vector<ListedMatrix> out;
  for (std::size_t row = 0; row < array.values.size() / width; ++row) {
    ListedMatrix& each = out.emplace_back();
    each.name = "row " + std::to_string(row);
    each.number = static_cast<double>(row);
    each.pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(
        array.values.data() + row * width);
  }
  return out;
}

/// Rows [stamp] x y z qx qy qz qw.
std::vector<ListedMatrix> matrices_of_quaternions(const std::string& name,
                                                  const NumpyArray& array,
                                                  std::size_t width,
                                                  ReadFindings& findings) {
  std::vector<ListedMatrix> out;
  for (std::size_t row = 0; row < array.values.size() / width; ++row) {
    const double* const v = array.values.data() + row * width + (width - 7);
    ListedMatrix& each = out.emplace_back();
    each.name = "row " + std::to_string(row);
    each.number = width == 8 ? v[-1] : static_cast<double>(row);
    Rotation q(v[6], v[3], v[4], v[5]);
    each.pose.translation() = Vector3(v[0], v[1], v[2]);
    each.pose.linear().setZero();  // without a pose
    if (!q.coeffs().allFinite() || q.coeffs().isZero(0.0)) continue;
    if (!normalise(q, findings.off_unit)) {
      throw input_error(name,
                        0,
                        each.name + ": quaternion has norm " + std::to_string(q.norm()) +
                            ", expected 1 +- 0.01 in columns qx qy qz qw");
    }
    each.pose.linear() = q.toRotationMatrix();
  }
  return out;
}

TrajectoryFile read_npy(const std::filesystem::path& file, const ReadOptions& options) {
  const std::string name = file.string();
  const NumpyArray array = parse_npy(name, read_named_file(file, kLargestNpy, "a .npy file"));
  const std::vector<std::size_t>& shape = array.shape;
  std::size_t width = shape.size() == 2 ? shape[1] : 0;
  if (shape.size() == 3) width = shape[1] * shape[2];
  const bool is_matrix = (shape.size() == 3 && shape[2] == 4) || shape.size() == 2;
  ReadFindings findings;
  findings.clock = width == 8 ? Clock::stamps : Clock::rows;
  std::vector<ListedMatrix> matrices;
  if (is_matrix && (width == 12 || width == 16)) {
    matrices = matrices_of(array, width);
  } else if (shape.size() == 2 && (width == 7 || width == 8)) {
    matrices = matrices_of_quaternions(name, array, width, findings);
  } else {
    std::string text;
    for (const std::size_t size : shape) text += (text.empty() ? "" : " x ") + std::to_string(size);
    throw input_error(
        name,
        0,
        "has shape " + text +
            ", expected N x 4 x 4, N x 3 x 4, N x 12, N x 16, N x 7 (x y z qx qy qz qw) "
            "or N x 8 (the same after a stamp)");
  }
  TrajectoryFile out = poses_of_matrices(name, matrices, options, std::move(findings));
  out.format = Format::npy;
  return out;
}

}  // namespace

FormatEntry npy_format() {
  return {.format = Format::npy, .guess_file = is_npy, .read_file = read_npy};
}

}  // namespace loopbench
