# Writes manual pages, changelog and copyright as Debian expects them.
# Manual pages are made of --help by help2man, if it is installed.
# cmake -DPROGRAM=... -DGZIP=... -DHELP2MAN=... -DOUT=... -DSOURCE=... -DVERSION=... -P package_files.cmake
file(REMOVE_RECURSE ${OUT})
file(MAKE_DIRECTORY ${OUT}/man1)
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${OUT}/changelog
"loopbench (${VERSION}) stable; urgency=medium

  * CHANGELOG.md beside this file lists the changes.

 -- The loopbench authors <loopbench@users.noreply.github.com>  ${now}
")
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
  string(REPLACE ";" "\\;" commands "${commands}")  # of summaries
  string(REGEX MATCHALL "[^\n]+" commands "${commands}")
  foreach(command IN LISTS commands)
    string(REGEX MATCH "^([^\t]*)\t(.*)$" found "${command}")
    set(name "${CMAKE_MATCH_1}")
    set(summary "${CMAKE_MATCH_2}")
    string(STRIP "${words} ${name}" name)
    page("${name}" "${summary}")
    separate_arguments(command UNIX_COMMAND "${name} --help")
    execute_process(COMMAND ${PROGRAM} ${command} OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
    if(help MATCHES "\nSubcommands:")
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

# stanza(<file>): its text as a field of Debian's copyright file
function(stanza out file)
  file(READ ${file} text)
  string(STRIP "${text}" text)
  string(REPLACE "\n\n" "\n.\n" text "${text}")
  string(REPLACE "\n" "\n " text "${text}")
  set(${out} " ${text}" PARENT_SCOPE)
endfunction()
stanza(d3_licence ${SOURCE}/harness/answers/report/assets/d3.LICENSE)
file(WRITE ${OUT}/copyright
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: loopbench

Files: *
Copyright: The loopbench authors
License: Apache-2.0
 On Debian systems, the full text of the Apache License, Version 2.0, is in
 /usr/share/common-licenses/Apache-2.0.

Files: harness/answers/report/assets/d3.min.js
Copyright: 2010-2023 Mike Bostock
License: ISC
${d3_licence}
Comment: embedded in the program, for its reports

Files: configs/example/fr1_room/reference.txt
Copyright: J. Sturm, N. Engelhard, F. Endres, W. Burgard and D. Cremers
License: CC-BY-4.0
 https://creativecommons.org/licenses/by/4.0/legalcode
Comment: an excerpt of the TUM RGB-D benchmark; README.md beside it has its source
")
