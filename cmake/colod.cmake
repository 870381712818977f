# Headers of libraries that nearly every source reads, parsed once for all targets of the same flags: one set for rooms that see CGAL,
# which adds -frounding-math, one for the others, one for tests. Only libraries' headers, so that a change of ours builds no more than
# before. docs/log/build-time.md has what it saves.
set(COLOD_PRECOMPILED <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits>
    <map> <memory> <numeric> <optional> <set> <sstream> <string> <tuple> <utility> <vector>)
if(CCACHE)  # which else keeps nothing that was built with precompiled headers
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

# colod_precompiled(NAME LINK ...): a target whose precompiled headers others reuse.
function(colod_precompiled name)
  cmake_parse_arguments(ARG "" "" "LINK;HEADERS" ${ARGN})
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/${name}.cpp CONTENT "")
  add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/generated/${name}.cpp)
  target_link_libraries(${name} PRIVATE Eigen3::Eigen colod_flags ${ARG_LINK})
  target_precompile_headers(${name} PRIVATE ${COLOD_PRECOMPILED} ${ARG_HEADERS})
endfunction()

# The room of the current folder: a static library of its sources. DOORS names the headers that others may include (else <room>.h
# alone; tests/doors.test.cpp sees to it), LINK what they need with them, PRIVATE what stays behind the doors, TOGETHER
# the sources that no file-local name stands twice in: ALL, or some.
function(colod_room name)
  cmake_parse_arguments(ARG "" "" "DOORS;LINK;PRIVATE;TOGETHER" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  add_library(colod_${name} STATIC ${sources})
  target_include_directories(colod_${name} PUBLIC ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR})
  target_link_libraries(colod_${name} PUBLIC ${ARG_LINK} PRIVATE ${ARG_PRIVATE} colod_flags)
  if(CGAL::CGAL IN_LIST ARG_PRIVATE)
    target_precompile_headers(colod_${name} REUSE_FROM colod_precompiled_cgal)
  else()
    target_precompile_headers(colod_${name} REUSE_FROM colod_precompiled)
  endif()
  colod_part(colod_${name})
  colod_together(colod_${name} ${ARG_TOGETHER})
endfunction()

# Compiles these sources of a target in one go, or ALL in batches, so that what they include is read and instantiated once: those
# that include CGAL in one, as its headers cost more than all others, the rest sixteen by sixteen.
# A batch's sources are no main file for the compiler, which then warns of types that a class keeps to its own source.
function(colod_together target)
  if(ARGN AND COLOD_UNITY)
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
  if(NOT ARGN)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${COLOD_UNITY} UNITY_BUILD_MODE GROUP)
  if(NOT "${ARGN}" STREQUAL "ALL")
    set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP together)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  set(count 0)
  foreach(source ${sources})
    file(STRINGS ${source} cgal REGEX "#include <CGAL/" LIMIT_COUNT 1)
    if(cgal)
      set(batch cgal)
    else()
      math(EXPR batch "${count} / 16")
      math(EXPR count "${count} + 1")
    endif()
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP batch_${batch})
  endforeach()
endfunction()

# Links a library if it was found; else <source>_none.cpp, which says that it is lacking, stands for <source>.cpp.
function(colod_optional target is_found library source)
  get_target_property(sources ${target} SOURCES)
  if(is_found)
    list(FILTER sources EXCLUDE REGEX "${source}_none\\.cpp$")
    target_link_libraries(${target} PRIVATE ${library})
  else()
    list(FILTER sources EXCLUDE REGEX "${source}\\.cpp$")
  endif()
  set_target_properties(${target} PROPERTIES SOURCES "${sources}")
endfunction()

# A static library that the shared one is made of: it can be moved, and shows nothing of itself.
function(colod_part target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()

# A page as a C++ text: `colod_page(out header symbol page.html style.css script.js...)` makes a source that defines `symbol`
# (declared in `header`), the HTML with styles and scripts where it says @STYLE@ and @SCRIPT@, and puts its path into `out`.
function(colod_page out header symbol html css)
  foreach(file ${html} ${css} ${ARGN})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${file})
  endforeach()
  set(script "")
  foreach(file ${ARGN})
    file(READ ${CMAKE_SOURCE_DIR}/${file} text)
    string(APPEND script "${text}")
  endforeach()
  file(READ ${CMAKE_SOURCE_DIR}/${css} style)
  file(READ ${CMAKE_SOURCE_DIR}/${html} page)
  string(REPLACE "@STYLE@" "${style}" page "${page}")
  string(REPLACE "@SCRIPT@" "${script}" page "${page}")
  set(source ${CMAKE_BINARY_DIR}/generated/${symbol}.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [=[// Made by CMake.
#include "@header@"
namespace colod {
const std::string_view @symbol@ = R"~page~(@page@)~page~";
}  // namespace colod
]=])
  set(${out} ${source} PARENT_SCOPE)
endfunction()

# Flags that every target of ours is built with.
add_library(colod_flags INTERFACE)
target_compile_options(colod_flags INTERFACE -Wall -Wextra -Wshadow $<$<BOOL:${COLOD_WERROR}>:-Werror>)
# Releases read files that anybody may have made: copies are checked against their bounds, stacks guarded, and the tables of library
# functions are filled and read-only before main.
target_compile_options(colod_flags INTERFACE $<$<CONFIG:Release>:-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2 -fstack-protector-strong>)
target_link_options(colod_flags INTERFACE $<$<CONFIG:Release>:-Wl,-z,relro,-z,now>)
# GCC 12 alone sees overlapping copies, and reads and writes beyond the end, where a text is joined to a std::string or moved into a vector of
# them; there are none, and clang and its sanitizers look as well (scripts/sanitize).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12
   AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(colod_flags INTERFACE -Wno-restrict -Wno-array-bounds -Wno-stringop-overread -Wno-stringop-overflow)
endif()
# GCC goes through its whole heap again and again for what it may forget; a batch of ours needs 1.6 GB at most without
# forgetting anything, and is compiled in a tenth to a fifth less time.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(colod_flags INTERFACE "SHELL:--param ggc-min-heapsize=2097152")
endif()
# Pragmas name warnings that GCC alone has.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  target_compile_options(colod_flags INTERFACE -Wno-unknown-warning-option)
endif()
if(COLOD_SANITIZE)
  list(JOIN COLOD_SANITIZE "," sanitizers)
  # A find ends the program, as a test that only prints it would pass.
  add_compile_options(-fsanitize=${sanitizers} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${sanitizers})
endif()

# tinygltf as a header that src/read/gltf_tinygltf.cpp compiles: Debian's libdraco exports the
# functions of another version of it, and which library a program takes them from would hang on the
# order of its link line. Without images, so that stb is not needed.
add_library(tinygltf_headers INTERFACE)
target_include_directories(tinygltf_headers SYSTEM INTERFACE $<TARGET_PROPERTY:TinyGLTF::TinyGLTF,INTERFACE_INCLUDE_DIRECTORIES>)
target_compile_definitions(tinygltf_headers INTERFACE TINYGLTF_NO_STB_IMAGE TINYGLTF_NO_STB_IMAGE_WRITE TINYGLTF_NO_EXTERNAL_IMAGE)

colod_precompiled(colod_precompiled)
colod_precompiled(colod_precompiled_cgal LINK CGAL::CGAL)
colod_part(colod_precompiled)  # with the flags of the rooms that reuse it
colod_part(colod_precompiled_cgal)
