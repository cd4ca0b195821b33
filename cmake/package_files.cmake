# Writes manual pages, completions, changelog and copyright as Debian expects them.
# Manual pages are made of --help by help2man, if it is installed.
# cmake -DPROGRAM=... -DGZIP=... -DHELP2MAN=... -DOUT=... -DSOURCE=... -DVERSION=... -P package_files.cmake
file(REMOVE_RECURSE ${OUT})
file(MAKE_DIRECTORY ${OUT}/man1)
execute_process(COMMAND ${PROGRAM} pages ${OUT} COMMAND_ERROR_IS_FATAL ANY)
file(COPY_FILE ${SOURCE}/CHANGELOG.md ${OUT}/changelog)
file(STRINGS ${OUT}/commands commands)
file(REMOVE ${OUT}/commands)
foreach(command IN LISTS commands)
  if(NOT HELP2MAN)
    break()
  endif()
  string(REGEX MATCH "^([^\t]*)\t(.*)$" found "${command}")
  set(words "${CMAKE_MATCH_1}")
  set(summary "${CMAKE_MATCH_2}")
  string(REPLACE " " "-" page "loopbench ${words}")
  string(REGEX REPLACE "-$" "" page "${page}")
  string(STRIP "${words} --help" help)
  execute_process(COMMAND ${HELP2MAN} --no-info --name "${summary}" --help-option "${help}"
                  --output ${OUT}/man1/${page}.1 ${PROGRAM} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
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
