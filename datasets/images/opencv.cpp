#include "datasets/images/opencv.hpp"

#include <opencv2/core/utility.hpp>

namespace loopbench::rgbd {

bool has_opencv() { return true; }

void run_opencv_on_one_thread() { cv::setNumThreads(1); }

}  // namespace loopbench::rgbd
