# Fails if two headers of the product declare types of the same name, in any namespaces, so that a name
# is unambiguous.
cmake_minimum_required(VERSION 3.25)

# Accepted duplicates, until one of the two types is renamed.
set(accepted "")

file(GLOB_RECURSE headers RELATIVE ${ROOT}
  ${ROOT}/datasets/*.hpp ${ROOT}/methods/*.hpp ${ROOT}/metrics/*.hpp ${ROOT}/harness/*.hpp)
set(found "")
foreach(header IN LISTS headers)
  # Declarations at the beginning of a line are at namespace scope: clang-format indents others.
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
    message(SEND_ERROR "${name} is declared once: remove it from the list of accepted names")
  endif()
endforeach()
