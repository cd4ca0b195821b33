/// The datasets from images: `rendered_room` and `rgbd`.
#pragma once

#include <vector>

#include "datasets/dataset.hpp"
#include "datasets/images/frontend.hpp"

namespace loopbench::rgbd {

/// Both run the front end, on rendered images of a synthetic room or on a recording. They throw
/// InputError, see open_rgbd_folder() and run_frontend().
std::vector<DatasetEntry> rgbd_datasets(const FrontendProgress& progress);

}  // namespace loopbench::rgbd
