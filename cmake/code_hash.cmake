# Writes OUT, a C++ file with the variable code_hash: a hash of FILES, libraries whose code affects results.
set(hashes "")
foreach(file IN LISTS FILES)
  file(SHA256 ${file} hash)
  string(APPEND hashes "${hash}\n")
endforeach()
string(SHA256 hash "${hashes}")
file(CONFIGURE OUTPUT ${OUT} CONTENT [[
char code_hash[] = "@hash@";
]] @ONLY)
