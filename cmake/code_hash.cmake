# Writes OUT, a C++ file with a hash of FILES: the libraries whose code affects the results of cells.
set(hashes "")
foreach(file IN LISTS FILES)
  file(SHA256 ${file} hash)
  string(APPEND hashes "${hash}\n")
endforeach()
string(SHA256 hash "${hashes}")
file(CONFIGURE OUTPUT ${OUT} CONTENT [[
char code_hash[] = "@hash@";
]] @ONLY)
