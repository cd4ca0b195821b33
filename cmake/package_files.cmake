# Writes manual pages, completions, changelog and copyright as Debian expects them.
# cmake -DPROGRAM=... -DGZIP=... -DOUT=... -DSOURCE=... -DVERSION=... -P package_files.cmake
file(REMOVE_RECURSE ${OUT})
file(MAKE_DIRECTORY ${OUT}/man1)
execute_process(COMMAND ${PROGRAM} pages ${OUT} COMMAND_ERROR_IS_FATAL ANY)
file(COPY_FILE ${SOURCE}/CHANGELOG.md ${OUT}/changelog)
file(GLOB pages ${OUT}/*.1)
foreach(page IN LISTS pages)
  get_filename_component(name ${page} NAME)
  file(RENAME ${page} ${OUT}/man1/${name})
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
