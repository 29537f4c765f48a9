# What `cmake --install` puts where, in parts (COMPONENT): `program`; one a plug-in, by its name (cmake/WhirlPlugin.cmake);
# `development`: every component but the commands as a static library with its headers, and the package whirl for
# find_package(): target whirl::whirl is all of them, whirl::<component> one.
# bin, lib/whirl and share are fixed: the program finds its plug-ins in ../lib/whirl (src/core/plugin.hpp).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS whirl RUNTIME DESTINATION bin COMPONENT program)
install(FILES docs/whirl.1 DESTINATION share/man/man1 COMPONENT program)
install(FILES LICENSE DESTINATION share/doc/whirl RENAME copyright COMPONENT program)
install(FILES README.md CHANGELOG.md docs/deck.md docs/guide.md docs/numerics.md docs/python.md docs/theory.md
        DESTINATION share/doc/whirl COMPONENT program)
install(DIRECTORY docs/deck docs/elements docs/analyses DESTINATION share/doc/whirl COMPONENT program FILES_MATCHING PATTERN "*.md")

# The program knows its own commands: it writes the completions.
set(completions ${CMAKE_BINARY_DIR}/completions)
file(MAKE_DIRECTORY ${completions})
add_custom_command(OUTPUT ${completions}/whirl ${completions}/whirl.fish
  COMMAND whirl completion bash > ${completions}/whirl
  COMMAND whirl completion fish > ${completions}/whirl.fish
  DEPENDS whirl VERBATIM)
add_custom_target(whirl_completions ALL DEPENDS ${completions}/whirl ${completions}/whirl.fish)
install(FILES ${completions}/whirl DESTINATION share/bash-completion/completions COMPONENT program)
install(FILES ${completions}/whirl.fish DESTINATION share/fish/vendor_completions.d COMPONENT program)

add_library(whirl_library INTERFACE)
set_target_properties(whirl_library PROPERTIES EXPORT_NAME whirl)
set_target_properties(whirl_flags PROPERTIES EXPORT_NAME flags)
add_library(whirl::whirl ALIAS whirl_library)
set(targets whirl_library whirl_flags)
get_property(components GLOBAL PROPERTY WHIRL_COMPONENTS)
list(REMOVE_ITEM components app)   # the command line is no library
foreach(component ${components})
  get_property(folder GLOBAL PROPERTY WHIRL_FOLDER_${component})
  set_target_properties(whirl_${component} PROPERTIES EXPORT_NAME ${component})
  target_link_libraries(whirl_library INTERFACE whirl_${component})
  list(APPEND targets whirl_${component})
  # sundials, hdf5 and vtk are what the plug-ins alone see
  install(DIRECTORY ${folder}/ DESTINATION include/whirl/${component} COMPONENT development
          FILES_MATCHING PATTERN "*.hpp" PATTERN visitor_overrides.inl PATTERN spin.inl PATTERN film_condense.inl
          PATTERN sundials EXCLUDE PATTERN hdf5 EXCLUDE PATTERN vtk EXCLUDE)
endforeach()
install(TARGETS ${targets} EXPORT whirl-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/whirl)
install(EXPORT whirl-targets NAMESPACE whirl:: DESTINATION ${package} COMPONENT development)
configure_package_config_file(cmake/whirl-config.cmake.in ${CMAKE_BINARY_DIR}/whirl-config.cmake INSTALL_DESTINATION ${package}
                              NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Before 1.0 a minor version may change headers (CONTRIBUTING.md).
write_basic_package_version_file(${CMAKE_BINARY_DIR}/whirl-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/whirl-config.cmake ${CMAKE_BINARY_DIR}/whirl-config-version.cmake
        DESTINATION ${package} COMPONENT development)
