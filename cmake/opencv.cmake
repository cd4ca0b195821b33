# The parts of OpenCV that datasets/rgbd uses. By hand: Debian ships OpenCVConfig.cmake only with
# libopencv-dev, which drags in every module and their graphics stacks.
find_path(LOOPBENCH_OPENCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
find_path(LOOPBENCH_STB_INCLUDE stb/stb_image.h REQUIRED)
add_library(loopbench_opencv INTERFACE)
target_include_directories(loopbench_opencv SYSTEM INTERFACE ${LOOPBENCH_OPENCV_INCLUDE})
foreach(part core imgproc features2d calib3d flann)
  find_library(LOOPBENCH_OPENCV_${part} opencv_${part} REQUIRED)
  target_link_libraries(loopbench_opencv INTERFACE ${LOOPBENCH_OPENCV_${part}})
endforeach()
