# Writes OUT, a C++ file with the bytes of FILES (paths below FOLDER): they are embedded in the program.
set(bytes "")
set(table "")
set(number 0)
foreach(file IN LISTS FILES)
  file(READ ${FOLDER}/${file} hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," hex "${hex}")
  string(APPEND bytes "const unsigned char bytes${number}[] = {${hex}0};\n")
  string(APPEND table "    {\"${file}\", {reinterpret_cast<const char*>(bytes${number}), sizeof bytes${number} - 1}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUT} "// Written by cmake/embed.cmake.
#include \"harness/answers/report/assets.hpp\"

namespace loopbench::harness {
namespace {
${bytes}}  // namespace

const std::vector<Asset>& assets() {
  static const std::vector<Asset> all{
${table}  };
  return all;
}

}  // namespace loopbench::harness
")
