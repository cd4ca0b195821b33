# The OpenCV modules used by datasets/images. Without find_package: OpenCVConfig.cmake is only in
# libopencv-dev, which depends on every module and its graphics stack. Without OpenCV the program
# is built without the image front end (exit code 4 if a config needs it).
find_path(LOOPBENCH_STB_INCLUDE stb/stb_image.h)
find_path(LOOPBENCH_OPENCV_INCLUDE opencv2/calib3d.hpp PATH_SUFFIXES opencv4)
add_library(loopbench_opencv INTERFACE)
if(LOOPBENCH_OPENCV_INCLUDE AND LOOPBENCH_STB_INCLUDE)
  target_include_directories(loopbench_opencv SYSTEM INTERFACE ${LOOPBENCH_OPENCV_INCLUDE})
  foreach(part core imgproc features2d calib3d flann)
    find_library(LOOPBENCH_OPENCV_${part} opencv_${part} REQUIRED)
    target_link_libraries(loopbench_opencv INTERFACE ${LOOPBENCH_OPENCV_${part}})
  endforeach()
  set(loopbench_images_except "/without_opencv\\.cpp$")
else()
  message(STATUS "OpenCV or stb was not found: building without the image front end")
  set(loopbench_images_except "/(opencv|find_features|match_exhaustive|pose_by_ransac|read_image)\\.cpp$")
endif()
