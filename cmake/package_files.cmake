# Writes manual pages, changelog and copyright as Debian expects them.
# Manual pages are made of --help by help2man, if it is installed.
# cmake -DPROGRAM=... -DGZIP=... -DHELP2MAN=... -DOUT=... -DSOURCE=... -DVERSION=... -P package_files.cmake
file(REMOVE_RECURSE ${OUT})
file(MAKE_DIRECTORY ${OUT}/man1)
file(COPY_FILE ${SOURCE}/CHANGELOG.md ${OUT}/changelog)
# page(<name of a command> <summary>): the manual page loopbench-<name>.1
function(page words summary)
  string(REPLACE " " "-" name "loopbench ${words}")
  string(REGEX REPLACE "-$" "" name "${name}")
  set(option --help)
  if(words STREQUAL "eval")
    set(option --help-all)
  endif()
  string(STRIP "${words} ${option}" help)
  execute_process(COMMAND ${HELP2MAN} --no-info --name "${summary}" --help-option "${help}"
                  --output ${OUT}/man1/${name}.1 ${PROGRAM} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
# pages(<words>): the pages of the commands that can follow, and of theirs
function(pages words)
  separate_arguments(before UNIX_COMMAND "${words}")
  execute_process(COMMAND ${PROGRAM} complete loopbench ${before} "" OUTPUT_VARIABLE commands
                  COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]+" commands "${commands}")
  foreach(command IN LISTS commands)
    string(REGEX MATCH "^([^\t]*)\t(.*)$" found "${command}")
    set(name "${CMAKE_MATCH_1}")
    set(summary "${CMAKE_MATCH_2}")
    string(STRIP "${words} ${name}" name)
    page("${name}" "${summary}")
    if(NOT name STREQUAL "help")
      pages("${name}")
    endif()
  endforeach()
endfunction()
if(HELP2MAN)
  page("" "Benchmark of loop-closure correction methods for trajectories")
  pages("")
endif()
file(GLOB pages ${OUT}/man1/*.1)
execute_process(COMMAND ${GZIP} -9n ${pages} ${OUT}/changelog COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${OUT}/copyright
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: loopbench

Files: *
Copyright: The loopbench authors
License: Apache-2.0
 On Debian systems, the full text of the Apache License, Version 2.0, is in
 /usr/share/common-licenses/Apache-2.0.
")
