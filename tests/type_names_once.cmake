# Fails when two headers of the product declare a type of one name: what a reader looks for by its
# name is then one thing, whatever its namespace.
cmake_minimum_required(VERSION 3.25)

# Names that mean two things for now; each stands here until one of the two has another name.
set(accepted "")

file(GLOB_RECURSE headers RELATIVE ${ROOT}
  ${ROOT}/datasets/*.hpp ${ROOT}/methods/*.hpp ${ROOT}/metrics/*.hpp ${ROOT}/harness/*.hpp)
set(found "")
foreach(header IN LISTS headers)
  # What stands at the beginning of a line is at namespace scope: clang-format indents the rest.
  file(STRINGS ${ROOT}/${header} lines
    REGEX "^(class|struct|union|enum|enum class|using|concept) [A-Za-z_0-9]+( final)?( [:={].*)?$")
  foreach(line IN LISTS lines)
    string(REGEX MATCH "^(enum class|[a-z]+) ([A-Za-z_0-9]+)" head "${line}")
    set(name ${CMAKE_MATCH_2})
    if(DEFINED header_of_${name} AND NOT name IN_LIST accepted)
      message(SEND_ERROR "${name} is declared in ${header_of_${name}} and in ${header}")
    elseif(DEFINED header_of_${name})
      list(APPEND found ${name})
    endif()
    set(header_of_${name} ${header})
  endforeach()
endforeach()
foreach(name IN LISTS accepted)
  if(NOT name IN_LIST found)
    message(SEND_ERROR "${name} is declared once: take it off the list of accepted names")
  endif()
endforeach()
