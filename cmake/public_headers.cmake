# cmake -DFROM=<source tree> -DTO=<folder> "-DHEADERS=kernel/ccd.h;..." -P public_headers.cmake
# Writes headers as users see them: what is "kernel/ccd.h" inside the tree is <selvage/kernel/ccd.h> there, so that no folder of
# theirs that is called kernel, io or sim can take its place. A file that would not change keeps its time.
cmake_minimum_required(VERSION 3.25)

foreach(header IN LISTS HEADERS)
  file(READ "${FROM}/${header}" text)
  string(REGEX REPLACE "\n#include \"([^\"\n]+)\"" "\n#include <selvage/\\1>" text "${text}")
  set(written "")
  if(EXISTS "${TO}/selvage/${header}")
    file(READ "${TO}/selvage/${header}" written)
  endif()
  if(NOT text STREQUAL written)
    file(WRITE "${TO}/selvage/${header}" "${text}")
  endif()
endforeach()
