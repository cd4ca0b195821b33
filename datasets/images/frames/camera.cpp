#include "datasets/images/frames/camera.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "datasets/columns/text_file.hpp"

namespace loopbench::rgbd {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

constexpr int kMostPixelsAcross = 8192;  // wider images are beyond the limit of pixels

/// One line `key: value`.
class CameraLine {
 public:
  CameraLine(const TextFile& file, const Line& line) : file_(file), line_(line.number) {
    const std::string_view text = line.text.substr(0, line.text.find(" #"));
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) {
      throw error(fmt::format("found '{}', expected 'key: value'", text));
    }
    key_ = trimmed(text.substr(0, colon));
    value_ = trimmed(text.substr(colon + 1));
  }

  std::string_view key() const { return key_; }
  InputError error(const std::string& what) const { return file_.error(line_, what); }

  double positive() const {
    const double value = number(value_);
    if (value > 0.0) return value;
    throw error(fmt::format("{} = {}: expected {} > 0", key_, value, key_));
  }

  int pixels() const {
    const double value = number(value_);
    if (value >= 1.0 && value <= kMostPixelsAcross && value == std::floor(value)) {
      return static_cast<int>(value);
    }
    throw error(fmt::format(
        "{} = {}: expected a whole number from 1 to {}", key_, value, kMostPixelsAcross));
  }

  std::vector<double> list() const {
    std::string_view rest = value_;
    if (rest.size() < 2 || rest.front() != '[' || rest.back() != ']') {
      throw error(fmt::format("{}: expected a list [k1, k2, p1, p2, k3]", key_));
    }
    rest = rest.substr(1, rest.size() - 2);
    std::vector<double> out;
    while (!trimmed(rest).empty()) {
      const std::size_t comma = rest.find(',');
      out.push_back(number(trimmed(rest.substr(0, comma))));
      rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
    }
    return out;
  }

 private:
  double number(std::string_view text) const {
    double value = 0.0;
    const char* const end = text.data() + text.size();
    const auto [stop, code] = std::from_chars(text.data(), end, value);
    if (code != std::errc{} || stop != end || !std::isfinite(value)) {
      throw error(fmt::format("{} = '{}': expected a number", key_, text));
    }
    return value;
  }

  const TextFile& file_;
  std::size_t line_;
  std::string_view key_;
  std::string_view value_;
};

}  // namespace

Camera read_camera(const std::filesystem::path& path) {
  TextFile file(path);
  Camera camera;
  const std::pair<const char*, double*> lengths[] = {{"fx", &camera.fx},
                                                     {"fy", &camera.fy},
                                                     {"cx", &camera.cx},
                                                     {"cy", &camera.cy},
                                                     {"depth_scale", &camera.depth_scale}};
  std::set<std::string, std::less<>> keys;
  for (Line text; file.next(text);) {
    const CameraLine line(file, text);
    if (!keys.emplace(line.key()).second) {
      throw line.error(fmt::format("key {} is repeated, expected each key once", line.key()));
    }
    for (const auto& [key, value] : lengths) {
      if (line.key() == key) *value = line.positive();
    }
    if (line.key() == "width") camera.width = line.pixels();
    if (line.key() == "height") camera.height = line.pixels();
    if (line.key() == "distortion") {
      std::vector<double> k = line.list();
      if (k.size() > 5) throw line.error("distortion: expected at most 5 numbers");
      k.resize(5, 0.0);
      camera.k1 = k[0], camera.k2 = k[1], camera.p1 = k[2], camera.p2 = k[3], camera.k3 = k[4];
    }
  }
  for (const char* key : {"fx", "fy", "cx", "cy"}) {
    if (!keys.contains(key))
      throw file.error(0, fmt::format("has no key {}, expected fx, fy, cx and cy", key));
  }
  if (camera.cx >= camera.width || camera.cy >= camera.height) {
    throw file.error(0,
                     fmt::format("principal point ({}, {}) is outside the image of {} x {} pixels",
                                 camera.cx,
                                 camera.cy,
                                 camera.width,
                                 camera.height));
  }
  return camera;
}

Camera tum_camera(int freiburg) {
  Camera out;
  const auto set = [&](double fx, double fy, double cx, double cy) {
    out.fx = fx, out.fy = fy, out.cx = cx, out.cy = cy;
  };
  const auto distort = [&](const std::array<double, 5>& k) {
    out.k1 = k[0], out.k2 = k[1], out.p1 = k[2], out.p2 = k[3], out.k3 = k[4];
  };
  switch (freiburg) {
    case 1:
      set(517.3, 516.5, 318.6, 255.3);
      distort({0.2624, -0.9531, -0.0054, 0.0026, 1.1633});
      return out;
    case 2:
      set(520.9, 521.0, 325.1, 249.7);
      distort({0.2312, -0.7849, -0.0033, -0.0001, 0.9172});
      return out;
    case 3:
      set(535.4, 539.2, 320.1, 247.6);
      return out;
    default:
      throw std::invalid_argument("tum_camera: expected 1, 2 or 3");
  }
}

}  // namespace loopbench::rgbd
