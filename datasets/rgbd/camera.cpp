#include "datasets/rgbd/camera.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "datasets/formats/text_file.hpp"

namespace loopbench::rgbd {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

constexpr int kMostPixelsAcross = 8192;  // wider images are beyond the limit of pixels

struct Entry {
  std::string_view key;
  std::string_view value;
};

class Reader {
 public:
  Reader(const TextFile& file, const Line& line) : file_(file), line_(line) {}

  Entry entry() const {
    const std::string_view text = line_.text.substr(0, line_.text.find(" #"));
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) {
      throw file_.error(line_.number, fmt::format("found '{}', expected 'key: value'", text));
    }
    return {trimmed(text.substr(0, colon)), trimmed(text.substr(colon + 1))};
  }

  double number(const Entry& entry) const {
    double value = 0.0;
    const char* const end = entry.value.data() + entry.value.size();
    const auto [stop, error] = std::from_chars(entry.value.data(), end, value);
    if (error != std::errc{} || stop != end || !std::isfinite(value)) {
      throw file_.error(line_.number,
                        fmt::format("{} = '{}': expected a number", entry.key, entry.value));
    }
    return value;
  }

  double positive(const Entry& entry) const {
    const double value = number(entry);
    if (value > 0.0) return value;
    throw file_.error(line_.number,
                      fmt::format("{} = {}: expected {} > 0", entry.key, value, entry.key));
  }

  int pixels(const Entry& entry) const {
    const double value = number(entry);
    if (value >= 1.0 && value <= kMostPixelsAcross && value == std::floor(value)) {
      return static_cast<int>(value);
    }
    throw file_.error(
        line_.number,
        fmt::format(
            "{} = {}: expected a whole number from 1 to {}", entry.key, value, kMostPixelsAcross));
  }

  std::vector<double> list(const Entry& entry) const {
    std::string_view rest = entry.value;
    if (rest.size() < 2 || rest.front() != '[' || rest.back() != ']') {
      throw file_.error(line_.number,
                        fmt::format("{}: expected a list [k1, k2, p1, p2, k3]", entry.key));
    }
    rest = rest.substr(1, rest.size() - 2);
    std::vector<double> out;
    while (!trimmed(rest).empty()) {
      const std::size_t comma = rest.find(',');
      out.push_back(number({entry.key, trimmed(rest.substr(0, comma))}));
      rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
    }
    return out;
  }

 private:
  const TextFile& file_;
  const Line& line_;
};

}  // namespace

Camera read_camera(const std::filesystem::path& path) {
  TextFile file(path);
  Camera camera;
  std::set<std::string, std::less<>> keys;
  Line line;
  while (file.next(line)) {
    const Reader reader(file, line);
    const Entry entry = reader.entry();
    if (!keys.emplace(entry.key).second) {
      throw file.error(line.number,
                       fmt::format("key {} is repeated, expected each key once", entry.key));
    }
    if (entry.key == "width") camera.width = reader.pixels(entry);
    if (entry.key == "height") camera.height = reader.pixels(entry);
    if (entry.key == "fx") camera.fx = reader.positive(entry);
    if (entry.key == "fy") camera.fy = reader.positive(entry);
    if (entry.key == "cx") camera.cx = reader.positive(entry);
    if (entry.key == "cy") camera.cy = reader.positive(entry);
    if (entry.key == "depth_scale") camera.depth_scale = reader.positive(entry);
    if (entry.key == "distortion") {
      std::vector<double> k = reader.list(entry);
      if (k.size() > 5) throw file.error(line.number, "distortion: expected at most 5 numbers");
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
