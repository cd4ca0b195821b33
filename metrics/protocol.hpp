/// How numbers are made, as a value that is printed beside them.
#pragma once

#include <string>

#include "datasets/core/fields.hpp"

namespace loopbench {

/// How reference and estimate are paired in time.
enum class Association {
  nearest,      ///< one-to-one, closest differences first, |dt| <= max_diff
  evo,          ///< evo 1.x: nearest for each pose of the shorter list; one may serve twice
  tum,          ///< TUM associate.py: one-to-one, greedy by difference, strict |dt| < max_diff
  interpolate,  ///< reference interpolated at the estimate's stamps, gaps up to max_gap
};
inline auto choices(Association) {
  return std::array{std::pair{"nearest", Association::nearest},
                    std::pair{"evo", Association::evo},
                    std::pair{"tum", Association::tum},
                    std::pair{"interpolate", Association::interpolate}};
}

/// What moves the estimate onto the reference before errors are taken.
enum class Align { se3, sim3, origin, none };
inline auto choices(Align) {
  return std::array{std::pair{"se3", Align::se3},
                    std::pair{"sim3", Align::sim3},
                    std::pair{"origin", Align::origin},
                    std::pair{"none", Align::none}};
}

/// When the estimate is judged.
enum class Times {
  keyframes,  ///< at its own keyframes
  dense,      ///< at every reference stamp inside its span, the curve asked between keyframes
};
inline auto choices(Times) {
  return std::array{std::pair{"keyframes", Times::keyframes}, std::pair{"dense", Times::dense}};
}

struct Protocol {
  Association association = Association::nearest;
  double max_diff = 0.02;
  double max_gap = 0.1;
  double offset = 0.0;
  Align align = Align::se3;
};

template <class Visit>
void fields(Protocol& o, Visit visit) {
  visit("association", o.association, "how keyframes and reference are paired in time");
  visit("max_diff", o.max_diff, "largest time difference of a pair [s]", Between{0.0});
  visit("max_gap", o.max_gap, "largest reference gap to interpolate over [s]", Above{0.0});
  visit("offset", o.offset, "added to the estimate's stamps [s]");
  visit("align", o.align, "what moves the estimate onto the reference");
}

}  // namespace loopbench
