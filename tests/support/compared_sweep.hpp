/// Records of a sweep whose verdicts are computed by hand.
#pragma once

#include "harness/answers/compare/verdict.hpp"
#include "tests/support/has.hpp"

namespace loopbench::compared_sweep {

using namespace methods;
using namespace metrics;
using namespace harness;

inline Record score(const std::string& sequence,
                    int repeat,
                    const std::string& method,
                    double rmse) {
  Record r;
  r.cell.edit().sequence = sequence;
  r.cell.edit().repeat = repeat;
  r.cell.edit().method = method;
  r.kind.edit().protocol = "loopbench";
  r.kind.edit().times = "dense";
  r.kind.edit().metric = "ate";
  r.kind.edit().relation = "translation";
  r.kind.edit().axis = "3d";
  r.kind.edit().unit = "m";
  r.statistics.rmse = rmse;
  return r;
}

/// A score of a protocol with options.
inline Record ate(const std::string& method, double rmse, int repeat = 0) {
  Record r = score("room", repeat, method, rmse);
  r.kind.edit().protocol = "evo (align=se3, first=10)";
  return r;
}

inline Record failed(const std::string& sequence, int repeat, const std::string& method) {
  Record r;
  r.cell.edit().sequence = sequence;
  r.cell.edit().repeat = repeat;
  r.cell.edit().method = method;
  r.status = Status::failed;
  return r;
}

/// Eight runs over two sequences of very different size: dual is 10 to 17 % below uniform on all
/// of them, raw has twice the error, copy equals uniform except for the last bits.
inline std::vector<Record> sweep() {
  std::vector<Record> out;
  for (int i = 0; i < 8; ++i) {
    const std::string sequence = i < 4 ? "room" : "city";
    const double size = i < 4 ? 0.05 : 50.0;
    const int repeat = i % 4;
    out.push_back(score(sequence, repeat, "uniform", size));
    out.push_back(score(sequence, repeat, "raw", 2.0 * size));
    out.push_back(score(sequence, repeat, "dual", (0.90 - 0.01 * i) * size));
    out.push_back(score(sequence, repeat, "copy", size * (1.0 + 1e-13)));
  }
  return out;
}

/// Sixteen seeds of four sequences: dual is 20 % below raw on one of them only.
inline std::vector<Record> one_of_four() {
  std::vector<Record> out;
  for (int seed = 0; seed < 16; ++seed) {
    for (const std::string sequence : {"room", "city", "hall", "sparse"}) {
      const double noise = 1.0 + 0.002 * ((seed * 7) % 16 - 7.5);
      out.push_back(score(sequence, seed, "raw", 1.0 + 0.1 * seed));
      out.push_back(score(sequence,
                          seed,
                          "dual",
                          (1.0 + 0.1 * seed) * noise * (sequence == "sparse" ? 0.8 : 0.999)));
    }
  }
  return out;
}

inline Comparison compared(const std::vector<Record>& records, CompareOptions options = {}) {
  if (options.baseline.empty()) options.baseline = "uniform";
  return compare(records, options).at(0);
}

}  // namespace loopbench::compared_sweep
