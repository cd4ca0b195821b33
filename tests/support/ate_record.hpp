/// A record of the metric `ate` on one sequence, for tests of tables.
#pragma once

#include <string>

#include "harness/model/record.hpp"

namespace loopbench::test {

inline harness::Record ate(const std::string& method, double rmse, int repeat = 0) {
  harness::Record r;
  r.sequence = "room";
  r.repeat = repeat;
  r.method = method;
  r.protocol = "evo (align=se3, first=10)";
  r.times = "dense";
  r.metric = "ate";
  r.relation = "translation";
  r.axis = "3d";
  r.unit = "m";
  r.statistics.rmse = rmse;
  return r;
}

}  // namespace loopbench::test
