#include "datasets/formats/pcd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "datasets/formats/regular_file.hpp"

namespace loopbench {
namespace {

constexpr std::array kCloudFields{"x", "y", "z", "roll", "pitch", "yaw", "time"};
using CloudRow = std::array<double, kCloudFields.size()>;

struct CloudField {
  std::string name;
  std::size_t bytes = 0;
  char type = 'F';
  std::size_t count = 1;
};

struct CloudHeader {
  std::vector<CloudField> fields;
  std::size_t points = 0;
  std::string data;
  std::size_t begin = 0;  ///< of the data [bytes]
};

CloudHeader cloud_header(const std::string& name, const std::string& bytes) {
  CloudHeader out;
  while (out.data.empty()) {
    const std::size_t end = bytes.find('\n', out.begin);
    if (end == bytes.npos) throw InputError(name + ": has no line DATA, expected a PCD file");
    std::istringstream line(bytes.substr(out.begin, end - out.begin));
    out.begin = end + 1;
    std::string key;
    line >> key;
    if (key == "FIELDS") {
      for (std::string field; line >> field;) out.fields.push_back({field});
    }
    for (CloudField& field : out.fields) {
      if (key == "SIZE") line >> field.bytes;
      if (key == "TYPE") line >> field.type;
      if (key == "COUNT") line >> field.count;
    }
    if (key == "POINTS") line >> out.points;
    if (key == "DATA") line >> out.data;
  }
  if (out.points > bytes.size()) {
    throw InputError(fmt::format(
        "{}: states {} points, expected at most one per byte of the file", name, out.points));
  }
  return out;
}

/// For each of kCloudFields its place in the header.
std::array<std::size_t, kCloudFields.size()> field_places(const std::string& name,
                                                          const CloudHeader& header) {
  std::array<std::size_t, kCloudFields.size()> out{};
  for (std::size_t k = 0; k < kCloudFields.size(); ++k) {
    const auto found = std::ranges::find(header.fields, kCloudFields[k], &CloudField::name);
    const bool is_number = found != header.fields.end() && found->type == 'F' &&
                           (found->bytes == 4 || found->bytes == 8) && found->count == 1;
    if (!is_number) {
      throw InputError(fmt::format(
          "{}: has no field '{}' of type F, expected x, y, z, roll, pitch, yaw and time",
          name,
          kCloudFields[k]));
    }
    out[k] = static_cast<std::size_t>(found - header.fields.begin());
  }
  return out;
}

std::vector<CloudRow> text_rows(const std::string& name,
                                const std::string& bytes,
                                const CloudHeader& header) {
  const auto wanted = field_places(name, header);
  std::istringstream in(bytes.substr(header.begin));
  std::vector<CloudRow> out(header.points);
  for (CloudRow& row : out) {
    for (std::size_t f = 0; f < header.fields.size(); ++f) {
      std::string word;
      for (std::size_t i = 0; i < header.fields[f].count; ++i) in >> word;
      const auto place = std::ranges::find(wanted, f);
      if (place == wanted.end()) continue;
      char* end = nullptr;
      row[static_cast<std::size_t>(place - wanted.begin())] = std::strtod(word.c_str(), &end);
      if (word.empty() || *end != 0) {
        throw InputError(fmt::format("{}: point {}: {} '{}' is not a number",
                                     name,
                                     &row - out.data(),
                                     header.fields[f].name,
                                     word));
      }
    }
  }
  return out;
}

std::vector<CloudRow> binary_rows(const std::string& name,
                                  const std::string& bytes,
                                  const CloudHeader& header) {
  const auto wanted = field_places(name, header);
  std::vector<std::size_t> offsets{0};
  for (const CloudField& field : header.fields)
    offsets.push_back(offsets.back() + field.bytes * field.count);
  const std::size_t width = offsets.back();
  const std::size_t present = (bytes.size() - header.begin) / width;
  if (present < header.points) {
    throw InputError(fmt::format("{}: ends after {} of {} points", name, present, header.points));
  }
  std::vector<CloudRow> out(header.points);
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const char* at = bytes.data() + header.begin + i * width + offsets[wanted[k]];
      float single = 0.0F;
      if (header.fields[wanted[k]].bytes == sizeof(double)) {
        std::memcpy(&out[i][k], at, sizeof(double));
      } else {
        std::memcpy(&single, at, sizeof(float));
        out[i][k] = static_cast<double>(single);
      }
    }
  }
  return out;
}

}  // namespace

bool is_pcd(const OpenedFile& file) {
  std::ifstream in(file.path, std::ios::binary);
  std::string first(7, 0);
  in.read(first.data(), static_cast<std::streamsize>(first.size()));
  return first.starts_with("# .PCD ") || first == "VERSION";
}

Trajectory read_pcd(const std::filesystem::path& file, const ReadOptions& options) {
  constexpr std::size_t kMost = std::size_t{1} << 30;  // [bytes]
  const std::string name = file.string();
  const std::string bytes = read_named_file(file, kMost, "a PCD file");
  const CloudHeader header = cloud_header(name, bytes);
  if (header.data != "ascii" && header.data != "binary") {
    throw InputError(name + ": has DATA " + header.data + ", expected ascii or binary");
  }
  Trajectory out;
  for (const CloudRow& v :
       header.data == "ascii" ? text_rows(name, bytes, header) : binary_rows(name, bytes, header)) {
    const Rotation rotation(Eigen::AngleAxisd(v[5], Vector3::UnitZ()) *
                            Eigen::AngleAxisd(v[4], Vector3::UnitY()) *
                            Eigen::AngleAxisd(v[3], Vector3::UnitX()));
    const StampedPose pose{v[6], {rotation, {v[0], v[1], v[2]}}};
    const bool repeats = !out.empty() && out.back().stamp == pose.stamp;
    if (repeats && options.repeats == Repeats::keep_first) continue;
    if (repeats && options.repeats == Repeats::keep_last) out.pop_back();
    out.push_back(pose);
  }
  check(out, name);
  return out;
}

}  // namespace loopbench
