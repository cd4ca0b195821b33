# Fails if a file includes a file that is not upstream of it, or a library outside the folder for it.

# What each part may include.
set(may_include_datasets/core "datasets/core")
set(may_include_datasets "datasets")
set(may_include_methods "datasets/core|methods")
set(may_include_metrics "datasets/core|methods/correctors/consensus|methods/solvers|metrics")
set(may_include_harness "datasets|methods|metrics|harness")

# Order within the parts: an entry (a folder, or the interface of a part and its catalogue) may include
# itself and the entries on lines above, but not the other entries on the same line. A file belongs to the
# longest entry that contains it.
set(order
  "datasets/core"
  "datasets/files"
  "datasets/compressed datasets/noise"
  "datasets/bags datasets/columns"
  "datasets/dataset datasets/formats"
  "datasets/derive"
  "datasets/simulated"
  "datasets/images/frames"
  "datasets/images/features"
  "datasets/images/tracking"
  "datasets/images/dense datasets/images/loops datasets/images/folder datasets/images/render"
  "datasets/images"
  "datasets"

  "methods/report"
  "methods/incremental"
  "methods/method"
  "methods/smoothers/runs methods/smoothers/penalised"
  "methods/smoothers/spline"
  "methods/smoothers/manifold/families"
  "methods/smoothers/gp methods/smoothers/manifold"
  "methods/solvers"
  "methods/smoothers methods/correctors"
  "methods/online"
  "methods"

  "metrics/numerics"
  "metrics/protocols"
  "metrics/trajectory metrics/alignment"
  "metrics/pairing"
  "metrics/evaluation"
  "metrics/better"
  "metrics/metric"
  "metrics/errors metrics/correction metrics/checks"
  "metrics/online"
  "metrics/doctor"
  "metrics"

  "harness/sweep/text"
  "harness/sweep/process"
  "harness/sweep/model"
  "harness/sweep/catalogue"
  "harness/sweep/config harness/sweep/run"
  "harness/sweep/store"
  "harness/answers/notes"
  "harness/answers/compare"
  "harness/answers/gate"
  "harness/answers/tables"
  "harness/answers/report"
  "harness/commands/files"
  "harness/commands"
  "harness/python"
)

# Only files that match folder_<library> may include the headers that match header_<library>.
set(libraries ceres yaml sqlite re2 xxhash cli json opencv stb compression pybind11)
set(header_ceres "ceres/")
set(folder_ceres "methods/solvers/")
set(header_yaml "yaml-cpp/")
set(folder_yaml "harness/sweep/config/")
set(header_sqlite "sqlite3")
set(folder_sqlite "harness/sweep/store/|datasets/bags/sqlite_file\\.cpp")  # stores, and files of others
set(header_re2 "re2/")
set(folder_re2 "harness/sweep/text/pattern\\.")
set(header_xxhash "xxhash")
set(folder_xxhash "harness/sweep/text/hash\\.cpp")
set(header_cli "CLI/")
set(folder_cli "harness/commands/")
set(header_json "nlohmann/")
set(folder_json "harness/(sweep/catalogue|answers|commands)/|harness/sweep/store/stored_options\\.cpp|datasets/formats/json(_graph)?\\.cpp")
set(header_opencv "opencv2/")
set(folder_opencv "datasets/images/.*\\.cpp")
set(header_stb "stb/")
set(folder_stb "datasets/images/.*\\.cpp")
set(header_compression "(zlib|bzlib|zstd|lz4frame)\\.h")
set(folder_compression "datasets/compressed/(de)?compress\\.cpp")
set(header_pybind11 "pybind11/")
set(folder_pybind11 "harness/python/")

set(level 0)
foreach(line IN LISTS order)
  math(EXPR level "${level} + 1")
  string(REPLACE " " ";" entries "${line}")
  foreach(entry IN LISTS entries)
    list(APPEND all_entries ${entry})
    set(level_${entry} ${level})
  endforeach()
endforeach()

# The longest entry of the order that contains a path; empty if none does.
function(find_entry path out)
  get_property(known GLOBAL PROPERTY entry_${path} SET)
  if(NOT known)
    set(longest "")
    set(length 0)
    foreach(entry IN LISTS all_entries)
      string(FIND "${path}/" "${entry}/" in_folder)
      string(FIND "${path}" "${entry}." as_file)
      string(LENGTH "${entry}" entry_length)
      if((in_folder EQUAL 0 OR as_file EQUAL 0) AND entry_length GREATER length)
        set(longest ${entry})
        set(length ${entry_length})
      endif()
    endforeach()
    set_property(GLOBAL PROPERTY entry_${path} "${longest}")
  endif()
  get_property(longest GLOBAL PROPERTY entry_${path})
  set(${out} "${longest}" PARENT_SCOPE)
endfunction()

foreach(folder datasets/core datasets methods metrics harness)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${folder}/*.hpp ${ROOT}/${folder}/*.cpp)
  foreach(file IN LISTS files)
    find_entry(${file} from)
    if(NOT from)
      message(SEND_ERROR "${file} is missing in the order of tests/includes_flow_one_way.cmake")
    endif()
    file(STRINGS ${ROOT}/${file} includes REGEX "^#include")
    foreach(line IN LISTS includes)
      if(line MATCHES "^#include \"" AND NOT line MATCHES "^#include \"(${may_include_${folder}})/")
        message(SEND_ERROR "${file}: ${line} points downstream")
      elseif(line MATCHES "^#include \"(${folder}/[^\"]+)\"")
        find_entry(${CMAKE_MATCH_1} to)
        if(NOT from STREQUAL to AND NOT level_${to} LESS level_${from})
          message(SEND_ERROR "${file}: ${line} points downstream, from ${from} to ${to}")
        endif()
      endif()
      foreach(library IN LISTS libraries)
        if(line MATCHES "<${header_${library}}" AND NOT file MATCHES "^(${folder_${library}})")
          message(SEND_ERROR "${file}: ${line} is allowed only in ${folder_${library}}")
        endif()
      endforeach()
      if(folder STREQUAL "datasets/core" AND line MATCHES "<(fmt|yaml-cpp|nlohmann|sqlite3|CLI|opencv2|stb)")
        message(SEND_ERROR "${file}: ${line}: core is std and Eigen only")
      endif()
    endforeach()
  endforeach()
endforeach()
