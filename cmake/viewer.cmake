# The page of `colod view`, bundled from npm packages into <build>/viewer, beside the program. Not part of `all`: this target, and
# nothing else, downloads, and only when src/viewer/package-lock.json has changed.
#   cmake --build --preset release --target viewer
set(viewer_source ${CMAKE_SOURCE_DIR}/src/viewer)
set(viewer_work ${CMAKE_BINARY_DIR}/viewer-packages)
file(GLOB viewer_files CONFIGURE_DEPENDS ${viewer_source}/*.js ${viewer_source}/*.mjs ${viewer_source}/*.json ${viewer_source}/*.html ${viewer_source}/*.css)
file(MAKE_DIRECTORY ${viewer_work})
add_custom_command(
  OUTPUT ${viewer_work}/node_modules/.package-lock.json
  COMMAND ${CMAKE_COMMAND} -E copy ${viewer_source}/package.json ${viewer_source}/package-lock.json ${viewer_work}
  COMMAND npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
  DEPENDS ${viewer_source}/package-lock.json
  WORKING_DIRECTORY ${viewer_work}
  COMMENT "Installing the npm packages of the viewer" VERBATIM)
add_custom_command(
  OUTPUT ${CMAKE_BINARY_DIR}/viewer/index.html
  COMMAND ${CMAKE_COMMAND} -E copy ${viewer_files} ${viewer_work}
  COMMAND node build.mjs ${CMAKE_BINARY_DIR}/viewer
  DEPENDS ${viewer_files} ${viewer_work}/node_modules/.package-lock.json
  WORKING_DIRECTORY ${viewer_work}
  COMMENT "Bundling the viewer" VERBATIM)
add_custom_target(viewer DEPENDS ${CMAKE_BINARY_DIR}/viewer/index.html)
