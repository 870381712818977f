# The room of the current folder: a static library of its sources. DOORS names the headers that others may include (else <room>.h
# alone; tests/doors.test.cpp sees to it), LINK what they need with them, PRIVATE what stays behind the doors.
function(colod_room name)
  cmake_parse_arguments(ARG "" "" "DOORS;LINK;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  add_library(colod_${name} STATIC ${sources})
  target_include_directories(colod_${name} PUBLIC ${CMAKE_SOURCE_DIR}/src ${CMAKE_SOURCE_DIR})
  target_link_libraries(colod_${name} PUBLIC ${ARG_LINK} PRIVATE ${ARG_PRIVATE} colod_flags)
  colod_part(colod_${name})
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
# GCC 12 alone sees overlapping copies where a text is joined to a std::string; there are none.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12
   AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(colod_flags INTERFACE -Wno-restrict)
endif()
if(COLOD_SANITIZE)
  list(JOIN COLOD_SANITIZE "," sanitizers)
  add_compile_options(-fsanitize=${sanitizers} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${sanitizers})
endif()

# tinygltf as a header that src/read/gltf_tinygltf.cpp compiles: Debian's libdraco exports the
# functions of another version of it, and which library a program takes them from would hang on the
# order of its link line. Without images, so that stb is not needed.
add_library(tinygltf_headers INTERFACE)
target_include_directories(tinygltf_headers SYSTEM INTERFACE $<TARGET_PROPERTY:TinyGLTF::TinyGLTF,INTERFACE_INCLUDE_DIRECTORIES>)
target_compile_definitions(tinygltf_headers INTERFACE TINYGLTF_NO_STB_IMAGE TINYGLTF_NO_STB_IMAGE_WRITE TINYGLTF_NO_EXTERNAL_IMAGE)
