# What cmake --install puts where, in the parts that packages are made of: program, library, development, python.
include(CMakePackageConfigHelpers)
set(manual ${CMAKE_BINARY_DIR}/manual)
add_custom_command(
  OUTPUT ${manual}/colod.1 ${manual}/colod.bash ${manual}/_colod ${manual}/colod.fish
  COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:colod> -DVERSION=${PROJECT_VERSION} -DOUT=${manual} -P ${CMAKE_SOURCE_DIR}/cmake/manual.cmake
  DEPENDS colod ${CMAKE_SOURCE_DIR}/cmake/manual.cmake
  COMMENT "Writing the man page and completions" VERBATIM)
add_custom_target(manual ALL DEPENDS ${manual}/colod.1)

install(TARGETS colod COMPONENT program)
install(FILES ${manual}/colod.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${manual}/colod.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME colod COMPONENT program)
install(FILES ${manual}/_colod DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${manual}/colod.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
install(DIRECTORY ${CMAKE_BINARY_DIR}/viewer/ DESTINATION ${CMAKE_INSTALL_DATADIR}/colod/viewer COMPONENT program OPTIONAL)

install(DIRECTORY workflow/ DESTINATION ${CMAKE_INSTALL_DATADIR}/colod/workflow COMPONENT program USE_SOURCE_PERMISSIONS)

install(TARGETS colod_library EXPORT colodTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(FILES include/colod/colod.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/colod COMPONENT development)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/colod)
file(WRITE ${CMAKE_BINARY_DIR}/colodConfig.cmake "include(\${CMAKE_CURRENT_LIST_DIR}/colodTargets.cmake)\n")
write_basic_package_version_file(${CMAKE_BINARY_DIR}/colodConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT colodTargets NAMESPACE colod:: DESTINATION ${package_folder} COMPONENT development)
install(FILES ${CMAKE_BINARY_DIR}/colodConfig.cmake ${CMAKE_BINARY_DIR}/colodConfigVersion.cmake DESTINATION ${package_folder} COMPONENT development)

# Relative to its own place, so that the installed tree may be moved.
file(RELATIVE_PATH prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/colod.pc.in ${CMAKE_BINARY_DIR}/colod.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/colod.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
