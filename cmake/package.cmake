# Installation and the Debian package: program, manual pages, completions, configs, documents.

# Packages for different systems depend on different libraries: version 1.0.0+debian12, so that 1.0.0+debian13 replaces it.
cmake_host_system_information(RESULT system QUERY DISTRIB_INFO)
execute_process(COMMAND dpkg --print-architecture OUTPUT_VARIABLE architecture
  OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE ignored ERROR_QUIET)
set(CPACK_DEBIAN_PACKAGE_VERSION ${PROJECT_VERSION}+${system_ID}${system_VERSION_ID})

set(pages ${PROJECT_BINARY_DIR}/pages)
find_program(gzip gzip REQUIRED)
find_program(help2man help2man)
if(NOT help2man)
  set(help2man "")
endif()
add_custom_command(OUTPUT ${pages}/copyright VERBATIM
  DEPENDS loopbench ${PROJECT_SOURCE_DIR}/cmake/package_files.cmake
  COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:loopbench> -DGZIP=${gzip} -DHELP2MAN=${help2man} -DOUT=${pages}
          -DSOURCE=${PROJECT_SOURCE_DIR} -DVERSION=${CPACK_DEBIAN_PACKAGE_VERSION}
          -P ${PROJECT_SOURCE_DIR}/cmake/package_files.cmake)
add_custom_target(loopbench_pages ALL DEPENDS ${pages}/copyright)

install(TARGETS loopbench COMPONENT program)
install(DIRECTORY ${pages}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(FILES cmake/package/completions/loopbench.bash COMPONENT program RENAME loopbench
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES cmake/package/completions/_loopbench COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES cmake/package/completions/loopbench.fish COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(PROGRAMS cmake/package/action.sh COMPONENT program DESTINATION ${CMAKE_INSTALL_DATADIR}/loopbench)
install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/loopbench COMPONENT program)
install(FILES ${pages}/copyright ${pages}/changelog.gz README.md CHANGELOG.md CITATION.cff COMPONENT program
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/loopbench)
# All that the README and the pages of the parts and the results link to, in its folders, so that the links work.
file(GLOB documents RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
  CONTRIBUTING.md */*.md harness/python/*.md results/*/*.md results/*/*.csv results/paper/*.svg results/methods/*.svg
  results/quickstart/report.* tests/plugin/example/* tests/plugin/stranger/half_way.cpp)
foreach(document IN LISTS documents)
  get_filename_component(folder ${document} DIRECTORY)
  install(FILES ${document} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/loopbench/${folder}
    COMPONENT program)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME loopbench)
set(CPACK_PACKAGE_VENDOR "loopbench")
set(CPACK_PACKAGE_CONTACT "The loopbench authors <loopbench@users.noreply.github.com>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "benchmark of loop-closure correction methods for SLAM")
set(CPACK_PACKAGE_DESCRIPTION
  "After a loop is detected, which method corrects the trajectory best, how much,
at what cost, and is the difference real? loopbench sweeps correctors and
smoothers over sequences, evaluates them under the protocols of published
tools, and tests the differences.")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL program)  # without the development files
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME loopbench_${PROJECT_VERSION}_${system_ID}${system_VERSION_ID}_${architecture}.deb)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "bubblewrap, python3-matplotlib")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR})
include(CPack)
