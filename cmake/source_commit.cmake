# Writes OUT, a C++ file with the commit of SOURCE; does not touch it if nothing changed.
set(commit "unknown")
set(state "unknown")
find_program(git git)
if(git)
  execute_process(COMMAND ${git} -C ${SOURCE} rev-parse HEAD
    OUTPUT_VARIABLE found RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT failed)
    set(commit ${found})
    execute_process(COMMAND ${git} -C ${SOURCE} status --porcelain --untracked-files=no
      OUTPUT_VARIABLE changes ERROR_QUIET)
    set(state "clean")
    if(changes)
      set(state "dirty")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT [[
// Written at every build.
char source_commit[] = "@commit@";
char source_state[] = "@state@";
]] @ONLY)
